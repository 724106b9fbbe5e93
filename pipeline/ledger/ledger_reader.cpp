#include "pipeline/ledger/layout_private.h"
#include "pipeline/ledger/ledger.h"
#include "pipeline/ledger/succession.h"

#include <stdlib.h>

#include <array>
#include <stdexcept>

namespace hsgm::ledger {

namespace {

constexpr std::array<const char*, 4> kStateNames{"pending", "running", "done", "failed"};

int small(const Statement& row, int column)
{
    return static_cast<int>(row.integer(column));
}

// From five columns that follow each other: the stage first.
tiling::Rect rect_at(const Statement& row, int column)
{
    return {small(row, column), small(row, column + 1), small(row, column + 2),
            small(row, column + 3)};
}

std::int64_t header_number(Database& database, const char* pragma)
{
    Statement row(database, pragma);
    return row.step() ? row.integer(0) : 0;
}

std::vector<AttemptRow> read_attempts(Database& database)
{
    Statement rows(database, "SELECT stage, row, col, rows, cols, token, worker, started_s, "
                             "seconds, outcome, reason FROM attempts ORDER BY id");
    std::vector<AttemptRow> attempts;
    while (rows.step()) {
        attempts.push_back({rows.text(0), rect_at(rows, 1), rows.integer(5), rows.text(6),
                            rows.number(7), rows.number(8), rows.text(9), rows.text(10)});
    }
    return attempts;
}

} // namespace

const char* name(TileState state)
{
    return kStateNames[static_cast<std::size_t>(state)];
}

TileState state_from_name(const std::string& name)
{
    for (std::size_t i = 0; i < kStateNames.size(); ++i) {
        if (name == kStateNames[i]) {
            return static_cast<TileState>(i);
        }
    }
    throw std::invalid_argument("there is no tile state '" + name + "'");
}

void check_layout(Database& database)
{
    if (header_number(database, "PRAGMA application_id") != kApplicationId) {
        throw DamagedError("The file " + database.path().string() + " is no ledger of hsgm.");
    }
    const std::int64_t version = header_number(database, "PRAGMA user_version");
    if (version != kLayoutVersion) {
        throw VersionError(
            "The ledger " + database.path().string() +
            " was written by another version of hsgm (layout " + std::to_string(version) +
            ", this one knows " + std::to_string(kLayoutVersion) +
            "); finish that run with its version, or begin anew with --restart.");
    }
}

std::vector<Owner> read_owners(Database& database)
{
    Statement rows(database, "SELECT token, part, host, pid, job, restarts, program, started_s "
                             "FROM owners ORDER BY token");
    std::vector<Owner> owners;
    while (rows.step()) {
        owners.push_back({rows.integer(0), small(rows, 1), rows.text(2), rows.integer(3),
                          rows.text(4), small(rows, 5), rows.text(6), rows.number(7)});
    }
    return owners;
}

std::vector<TileRow> read_tiles(Database& database, const std::string& stage)
{
    Statement rows(database,
                   "SELECT stage, row, col, rows, cols, state, attempts, deaths, part, worker, "
                   "started_s, seconds, checksum, reason FROM tiles WHERE ? IN ('', stage) "
                   "ORDER BY id");
    rows.bind(stage);
    std::vector<TileRow> tiles;
    while (rows.step()) {
        tiles.push_back({rows.text(0), rect_at(rows, 1), state_from_name(rows.text(5)),
                         small(rows, 6), small(rows, 7), small(rows, 8), rows.text(9),
                         rows.number(10), rows.number(11), rows.text(12), rows.text(13)});
    }
    return tiles;
}

namespace {

Contents read_contents(const std::filesystem::path& path)
{
    Database database(path, Database::Access::read);
    check_layout(database);
    // One transaction, so that all tables are of one moment.
    database.execute("BEGIN");
    Contents contents;
    Statement facts(database, "SELECT name, value FROM facts");
    while (facts.step()) {
        contents.facts[facts.text(0)] = facts.text(1);
    }
    contents.owners = read_owners(database);
    contents.tiles = read_tiles(database, "");
    contents.attempts = read_attempts(database);
    return contents;
}

/// A folder for a copy that is read and forgotten.
class PassingFolder {
public:
    PassingFolder()
    {
        std::string name =
            (std::filesystem::temp_directory_path() / "hsgm-ledger-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) {
            throw io::StorageError("Cannot make a temporary folder " + name + ".");
        }
        path_ = name;
    }
    ~PassingFolder()
    {
        std::error_code none;
        std::filesystem::remove_all(path_, none);
    }
    PassingFolder(const PassingFolder&) = delete;
    PassingFolder& operator=(const PassingFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

} // namespace

Contents read_ledger(const std::filesystem::path& path)
{
    try {
        return read_contents(path);
    } catch (const BusyError&) {
        const PassingFolder folder;
        const auto copy = folder.path() / path.filename();
        copy_ledger(path, copy);
        return read_contents(copy);
    }
}

} // namespace hsgm::ledger
