#include "pipeline/stages/earlier_run.h"

#include "io/error.h"
#include "pipeline/stages/fingerprint_stage.h"
#include "pipeline/stages/tile_stage.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>

namespace hsgm::pipeline {

namespace {

using ledger::Contents;
using ledger::Facts;
using ledger::TileState;

constexpr const char* kPrefix = "defines: ";
constexpr const char* kAssembled = "assembled";

// Of a damaged ledger nothing is known; whoever opens it to write sets it aside.
Contents contents_of(const std::filesystem::path& path)
{
    if (!std::filesystem::exists(path)) {
        return {};
    }
    try {
        return ledger::read_ledger(path);
    } catch (const ledger::DamagedError&) {
        return {};
    }
}

Facts fingerprint_in(const Facts& facts)
{
    Facts fingerprint;
    for (const auto& [name, value] : facts) {
        if (name.starts_with(kPrefix)) {
            fingerprint[name.substr(std::string(kPrefix).size())] = value;
        }
    }
    return fingerprint;
}

std::string assembled_of(std::size_t tiles_failed, int tiles_done)
{
    return fmt::format("{} done, {} failed", tiles_done, tiles_failed);
}

void refuse_differences(const RunLayout& layout, const std::vector<std::string>& found)
{
    if (!found.empty()) {
        throw io::ConfigError(fmt::format(
            "The run in {} cannot be resumed, because what defines its result has changed: {}; "
            "undo that, or begin anew with --restart",
            layout.root.string(), fmt::join(found, "; ")));
    }
}

void require_same(const RunLayout& layout, const Facts& facts, const Facts& now)
{
    const Facts before = fingerprint_in(facts);
    if (!before.empty()) {
        refuse_differences(layout, ledger::differences(before, now));
    }
}

std::int64_t tiles_done_in(const RunLayout& layout)
{
    std::int64_t done = 0;
    for (const tiling::Shard shard : layout.shards()) {
        for (const auto& row : contents_of(layout.tiles_ledger(shard)).tiles) {
            done += row.stage == kMatchStage && row.state == TileState::done;
        }
    }
    return done;
}

// With the lock of the coarse stage, so that nobody begins meanwhile.
void throw_away(const RunLayout& layout)
{
    const auto coarse = layout.coarse_ledger();
    for (const auto& path : layout.all_ledgers()) {
        const auto lock = RunLayout::lock_of(path);
        if (path != coarse && ledger::FileLock::is_held(lock)) {
            throw io::StorageError(
                fmt::format("{} is at work on {}; wait for it, stop it, or name another output "
                            "folder",
                            ledger::FileLock::holder(lock), layout.root.string()));
        }
    }
    for (const auto& path : layout.all_ledgers()) {
        std::filesystem::remove(path);
        std::filesystem::remove(path.string() + "-journal");
    }
    std::filesystem::remove_all(layout.work());
}

[[noreturn]] void refuse_unfinished(const RunLayout& layout, std::int64_t tiles_done)
{
    throw io::ConfigError(fmt::format("{} holds an unfinished run ({} tiles done): go on with "
                                      "--resume, or throw it away with --restart",
                                      layout.root.string(), tiles_done));
}

} // namespace

Facts as_facts(const Facts& fingerprint)
{
    Facts facts;
    for (const auto& [name, value] : fingerprint) {
        facts[kPrefix + name] = value;
    }
    return facts;
}

bool is_finished(const RunLayout& layout)
{
    const Facts facts = contents_of(layout.assemble_ledger()).facts;
    const auto assembled = facts.find(kAssembled);
    return assembled != facts.end() && assembled->second.ends_with(" 0 failed");
}

void mark_assembled(const OwnedLedger& book, std::size_t tiles_failed, int tiles_done)
{
    book->set_facts({{kAssembled, assembled_of(tiles_failed, tiles_done)}});
}

bool is_assembled(const OwnedLedger& book, std::size_t tiles_failed, int tiles_done)
{
    const Facts facts = book->facts();
    const auto assembled = facts.find(kAssembled);
    return assembled != facts.end() &&
           assembled->second == assembled_of(tiles_failed, tiles_done);
}

void judge_earlier_run(const RunLayout& layout, const RunManner& manner,
                       const Facts& fingerprint)
{
    if (layout.all_ledgers().empty()) {
        return;
    }
    if (manner.restart) {
        throw_away(layout);
        return;
    }
    const bool finished = is_finished(layout);
    if (finished && !manner.resume) {
        throw_away(layout);
        return;
    }
    const std::int64_t done = tiles_done_in(layout);
    // Of shards, each answers for its own tiles.
    if (!manner.resume && !manner.shard) {
        if (done > 0) {
            refuse_unfinished(layout, done);
        }
        throw_away(layout);
        return;
    }
    require_same(layout, contents_of(layout.coarse_ledger()).facts, fingerprint);
    if (manner.resume && !manner.shard && done > 0) {
        spdlog::info("resuming: {} tiles are done", done);
    }
}

void judge_earlier_pixels(const RunLayout& layout, const PlannedJob& planned)
{
    refuse_differences(layout,
                       changed_pixels(planned, contents_of(layout.coarse_ledger()).facts));
}

void discard(const RunLayout& layout)
{
    std::error_code none;
    std::filesystem::remove_all(layout.work(), none);
    std::filesystem::remove_all(layout.ledgers(), none);
}

void judge_earlier_shard(const RunLayout& layout, tiling::Shard shard, const RunManner& manner,
                         const Facts& fingerprint)
{
    for (const tiling::Shard other : layout.shards()) {
        if (other.count != shard.count) {
            throw io::ConfigError(fmt::format(
                "The run in {} was begun with {} shards, not {}; go on with as many, or begin "
                "anew with --restart",
                layout.root.string(), other.count, shard.count));
        }
    }
    const Contents earlier = contents_of(layout.tiles_ledger(shard));
    require_same(layout, earlier.facts, fingerprint);
    const auto done = std::count_if(
        earlier.tiles.begin(), earlier.tiles.end(), [](const ledger::TileRow& row) {
            return row.stage == kMatchStage && row.state == TileState::done;
        });
    if (done > 0 && manner.shard && !manner.resume) {
        refuse_unfinished(layout, done);
    }
    if (done > 0 && manner.shard) {
        spdlog::info("resuming: {} tiles are done", done);
    }
}

void require_coarse_stage(const RunLayout& layout, const Facts& fingerprint)
{
    const Contents coarse = contents_of(layout.coarse_ledger());
    const bool begun = !coarse.tiles.empty();
    const bool done = std::all_of(coarse.tiles.begin(), coarse.tiles.end(),
                                  [](const auto& row) { return row.state == TileState::done; });
    if (!begun || !done) {
        throw io::ConfigError(fmt::format("The coarse stage of the run in {} is {}; carry out "
                                          "--stage coarse before the others",
                                          layout.root.string(),
                                          begun ? "not finished" : "not there"));
    }
    require_same(layout, coarse.facts, fingerprint);
}

} // namespace hsgm::pipeline
