#include "pipeline/ledger/ledger.h"

#include "pipeline/ledger/layout_private.h"
#include "pipeline/ledger/succession.h"

#include <algorithm>
#include <tuple>

namespace hsgm::ledger {

namespace {

Statement& bind_key(Statement& statement, const std::string& stage, const tiling::Rect& r)
{
    return statement.bind(stage)
        .bind(std::int64_t{r.row})
        .bind(std::int64_t{r.col})
        .bind(std::int64_t{r.rows})
        .bind(std::int64_t{r.cols});
}

} // namespace

Ledger::Ledger(const std::filesystem::path& path, bool fleeting)
    : database_(path, fleeting ? Database::Access::fleeting : Database::Access::make)
{
    database_.check_whole();
    begin();
    check_layout(database_);
}

// Makes the tables of a new file, or of one whose maker was killed before they were there.
void Ledger::begin()
{
    Transaction transaction(database_);
    {
        Statement tables(database_, "SELECT count(*) FROM sqlite_master");
        tables.step();
        if (tables.integer(0) > 0) {
            return;
        }
    }
    database_.execute(kTables);
    database_.execute(("PRAGMA application_id = " + std::to_string(kApplicationId) +
                       "; PRAGMA user_version = " + std::to_string(kLayoutVersion))
                          .c_str());
    transaction.commit();
}

Facts Ledger::facts() const
{
    const std::scoped_lock lock(mutex_);
    Facts facts;
    Statement rows(database_, "SELECT name, value FROM facts");
    while (rows.step()) {
        facts[rows.text(0)] = rows.text(1);
    }
    return facts;
}

void Ledger::set_facts(const Facts& facts)
{
    const std::scoped_lock lock(mutex_);
    Transaction transaction(database_);
    require_token();
    Statement put(database_, "INSERT OR REPLACE INTO facts(name, value) VALUES(?, ?)");
    for (const auto& [name, value] : facts) {
        put.bind(name).bind(value).run();
    }
    transaction.commit();
}

Owner Ledger::take(Owner owner, bool new_part)
{
    const std::scoped_lock lock(mutex_);
    Transaction transaction(database_);
    Statement last(database_,
                   "SELECT coalesce(max(token), 0), coalesce(max(part), 0) FROM owners");
    last.step();
    owner.token = last.integer(0) + 1;
    const auto last_part = static_cast<int>(last.integer(1));
    owner.part = new_part ? std::max(last_part + 1, owner.part) : last_part;
    last.step();
    Statement put(database_, "INSERT INTO owners VALUES(?, ?, ?, ?, ?, ?, ?, ?)");
    put.bind(owner.token).bind(std::int64_t{owner.part}).bind(owner.host).bind(owner.pid);
    put.bind(owner.job).bind(std::int64_t{owner.restarts}).bind(owner.program);
    put.bind(owner.started_s).run();
    database_.execute(
        "INSERT INTO attempts(stage, row, col, rows, cols, token, worker, started_s, seconds, "
        "outcome, reason) SELECT stage, row, col, rows, cols, (SELECT max(token) - 1 FROM "
        "owners),"
        " worker, started_s, 0, 'died', 'the process ended meanwhile' FROM tiles "
        "WHERE state = 'running';"
        "UPDATE tiles SET state = 'pending', deaths = deaths + 1 WHERE state = 'running'");
    transaction.commit();
    token_ = owner.token;
    part_ = owner.part;
    return owner;
}

std::vector<Owner> Ledger::owners() const
{
    const std::scoped_lock lock(mutex_);
    return read_owners(database_);
}

std::vector<TileRow> Ledger::tiles(const std::string& stage) const
{
    const std::scoped_lock lock(mutex_);
    return read_tiles(database_, stage);
}

void Ledger::plan(const std::string& stage, std::span<const tiling::Rect> tiles)
{
    const std::scoped_lock lock(mutex_);
    Transaction transaction(database_);
    require_token();
    std::vector<TileRow> earlier = read_tiles(database_, stage);
    Statement remove(database_, "DELETE FROM tiles WHERE stage = ? AND state <> 'done'");
    remove.bind(stage).run();
    Statement put(database_,
                  "INSERT OR REPLACE INTO tiles(stage, row, col, rows, cols, state, attempts, "
                  "deaths, reason) VALUES(?, ?, ?, ?, ?, 'pending', ?, ?, ?)");
    const auto before = [](const tiling::Rect& a, const tiling::Rect& b) {
        return std::tie(a.row, a.col, a.rows, a.cols) < std::tie(b.row, b.col, b.rows, b.cols);
    };
    std::sort(earlier.begin(), earlier.end(),
              [&](const TileRow& a, const TileRow& b) { return before(a.rect, b.rect); });
    for (const tiling::Rect& tile : tiles) {
        const auto same = std::lower_bound(
            earlier.begin(), earlier.end(), tile,
            [&](const TileRow& row, const tiling::Rect& r) { return before(row.rect, r); });
        const TileRow known = same != earlier.end() && same->rect == tile ? *same : TileRow{};
        bind_key(put, stage, tile)
            .bind(std::int64_t{known.attempts})
            .bind(std::int64_t{known.deaths})
            .bind(known.reason)
            .run();
    }
    transaction.commit();
}

void Ledger::require_token()
{
    Statement last(database_, "SELECT coalesce(max(token), 0) FROM owners");
    last.step();
    const bool succeeded = std::filesystem::exists(successor_of(path()));
    if (token_ > 0 && (last.integer(0) > token_ || succeeded)) {
        throw TakenOverError("Another process took over the ledger " + path().string() +
                             "; what this one did since is not recorded, and nothing is lost.");
    }
}

void Ledger::apply(const TileEvent& event)
{
    Statement update(
        database_,
        event.state == TileState::running
            ? "UPDATE tiles SET state = ?, part = ?, worker = ?, started_s = ?, seconds = ?, "
              "checksum = ?, attempts = attempts + 1 "
              "WHERE stage = ? AND row = ? AND col = ? AND rows = ? AND cols = ?"
            : "UPDATE tiles SET state = ?, part = ?, worker = ?, started_s = ?, seconds = ?, "
              "checksum = ?, reason = ? "
              "WHERE stage = ? AND row = ? AND col = ? AND rows = ? AND cols = ?");
    update.bind(std::string(name(event.state))).bind(std::int64_t{part_}).bind(event.worker);
    update.bind(event.started_s).bind(event.seconds).bind(event.checksum);
    if (event.state != TileState::running) {
        update.bind(event.reason);
    }
    bind_key(update, event.stage, event.rect).run();
    const bool ended = event.state == TileState::done || !event.reason.empty();
    if (event.state == TileState::running || !ended) {
        return;
    }
    Statement attempt(
        database_,
        "INSERT INTO attempts(stage, row, col, rows, cols, token, worker, "
        "started_s, seconds, outcome, reason) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    bind_key(attempt, event.stage, event.rect).bind(token_).bind(event.worker);
    attempt.bind(event.started_s).bind(event.seconds);
    attempt.bind(std::string(event.state == TileState::done ? "done" : "failed"));
    attempt.bind(event.reason).run();
}

void Ledger::commit(std::span<const TileEvent> events)
{
    const std::scoped_lock lock(mutex_);
    Transaction transaction(database_);
    require_token();
    for (const TileEvent& event : events) {
        apply(event);
    }
    transaction.commit();
}

} // namespace hsgm::ledger
