#include "pipeline/stages/match_stage.h"

#include "io/disk_room.h"
#include "io/error.h"
#include "io/pending_file.h"
#include "io/scratch_folder.h"
#include "pipeline/error.h"
#include "pipeline/freed_memory.h"
#include "pipeline/run_log.h"
#include "pipeline/stages/assemble_stage.h"
#include "pipeline/stages/earlier_run.h"
#include "pipeline/stages/fingerprint_stage.h"
#include "pipeline/stages/pair_stage.h"
#include "pipeline/stages/report_stage.h"
#include "pipeline/stages/run_record.h"
#include "pipeline/stages/stored_geometry.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace hsgm::pipeline {

namespace {

using tiling::Shard;

constexpr std::size_t kFailuresShown = 10;

std::filesystem::path folder_of(const std::filesystem::path& file)
{
    return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

void make_folder(const std::filesystem::path& folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw io::StorageError(
            fmt::format("Cannot make the folder {}: {}.", folder.string(), error.message()));
    }
}

/// One call of run_job, stage by stage.
class Run {
public:
    Run(const PlannedJob& planned, const RunManner& manner, RunLayout layout,
        const Progress& progress)
        : planned_(planned), manner_(manner), layout_(std::move(layout)), progress_(progress)
    {
    }

    RunResult carry_out();

private:
    bool does(RunStage stage) const
    {
        return manner_.stage == RunStage::all || manner_.stage == stage;
    }
    std::optional<OwnedLedger> take(const std::filesystem::path& ledger, WhenHeld when_held,
                                    std::function<void()> once_locked = {}) const;
    bool outputs_are_there() const;
    void check_room() const;
    std::string log_name() const;
    void log_coarse_stages() const;
    void do_coarse();
    void do_tiles(Shard shard);
    void do_assemble();
    void finish(const OwnedLedger& book, const TilesOfRun& tiles);
    void remove_leftovers(const OutputPaths& o) const;
    int shard_count() const;

    const PlannedJob& planned_;
    const RunManner& manner_;
    RunLayout layout_;
    const Progress& progress_;
    ledger::Facts fingerprint_;
    bool already_finished_ = false;
    RunResult result_;
};

RunResult Run::carry_out()
{
    if (manner_.is_durable()) {
        fingerprint_ = fingerprint(planned_, manner_.settings);
    }
    check_room();
    do_coarse();
    if (already_finished_) {
        spdlog::info("{}: everything is done already", layout_.root.string());
        return {};
    }
    std::optional<LogFile> log;
    if (manner_.is_durable()) {
        log.emplace(layout_.root / "logs" / (log_name() + ".jsonl"));
        log_event("begin", {{"program", "hsgm " HSGM_VERSION},
                            {"threads", planned_.budget.threads},
                            {"tile_size_px", planned_.budget.tile_size_px},
                            {"memory_estimate_bytes", planned_.budget.estimate_bytes},
                            {"resume", manner_.resume}});
        log_coarse_stages();
    }
    if (does(RunStage::tiles)) {
        const int count = shard_count();
        for (int index = 0; index < count; ++index) {
            if (!manner_.shard || manner_.shard->index == index) {
                do_tiles({index, count});
            }
        }
    }
    if (does(RunStage::assemble)) {
        do_assemble();
    }
    log_event("end", {{"tiles_done", result_.tiles_done},
                      {"tiles_failed", result_.failed.size()},
                      {"assembled", result_.summary.has_value()}});
    return std::move(result_);
}

// They were over before there was a log: a run that is refused leaves none.
void Run::log_coarse_stages() const
{
    if (!does(RunStage::coarse)) {
        return;
    }
    const ledger::Contents book = ledger::read_ledger(layout_.coarse_ledger());
    for (const ledger::AttemptRow& attempt : book.attempts) {
        if (attempt.token == book.owners.back().token) {
            log_event("stage", {{"stage", attempt.stage},
                                {"state", attempt.outcome},
                                {"seconds", attempt.seconds},
                                {"reason", attempt.reason}});
        }
    }
}

// One log for each part of a run, which later attempts go on with.
std::string Run::log_name() const
{
    if (manner_.shard) {
        return "tiles-" + name(*manner_.shard);
    }
    switch (manner_.stage) {
    case RunStage::coarse:
        return "coarse";
    case RunStage::assemble:
        return "assemble";
    default:
        return "run";
    }
}

// As many as there are already, where this process is not one of them.
int Run::shard_count() const
{
    if (manner_.shard) {
        return manner_.shard->count;
    }
    const auto shards = layout_.shards();
    return shards.empty() ? 1 : shards.back().count;
}

// Before anything is written: what this call will need on the disk, less what an earlier one
// has taken already.
void Run::check_room() const
{
    const Budget& budget = planned_.budget;
    std::int64_t scratch = does(RunStage::coarse) ? budget.pyramid_disk_bytes : 0;
    if (does(RunStage::tiles)) {
        const int rows = manner_.shard ? band_of(planned_.shape.left, *manner_.shard).rows
                                       : planned_.shape.left.rows;
        scratch += FirstPass::disk_bytes(planned_.shape, rows);
    }
    const std::int64_t results = does(RunStage::assemble) ? budget.output_disk_bytes : 0;
    const auto free = io::free_bytes(layout_.root);
    const std::int64_t needed = scratch + results - io::bytes_taken(layout_.work());
    if (free && needed > *free) {
        constexpr std::int64_t kMiB = std::int64_t{1} << 20;
        throw io::StorageError(fmt::format(
            "the run needs {} MiB on the disk of {} ({} between its stages, {} of results at "
            "most), but {} MiB are free; make room, or name another output",
            needed / kMiB + 1, folder_of(planned_.job.outputs.disparity).string(),
            scratch / kMiB + 1, results / kMiB + (results > 0), *free / kMiB));
    }
}

void Run::do_coarse()
{
    if (!does(RunStage::coarse)) {
        already_finished_ = manner_.resume && is_finished(layout_) && outputs_are_there();
        require_coarse_stage(layout_, fingerprint_);
        return;
    }
    make_folder(layout_.ledgers());
    // Shards that begin at once wait for the one that prepares the pair for all of them.
    const auto book =
        take(layout_.coarse_ledger(), manner_.shard ? WhenHeld::wait : WhenHeld::refuse, [&] {
            judge_earlier_run(layout_, manner_, fingerprint_);
            judge_earlier_pixels(layout_, planned_);
            already_finished_ = is_finished(layout_) && outputs_are_there();
        });
    if (already_finished_) {
        return;
    }
    try {
        (*book)->set_facts(as_facts(fingerprint_));
        keep_geometry(planned_.job, layout_);
        prepare_pair(planned_, layout_, *book, manner_.is_durable());
        give_back_freed_memory();
    } catch (...) {
        // Nothing is worth resuming: what bad input leaves is what was there before it.
        if (!manner_.shard && layout_.shards().empty()) {
            discard(layout_);
        }
        throw;
    }
}

std::optional<OwnedLedger> Run::take(const std::filesystem::path& ledger, WhenHeld when_held,
                                     std::function<void()> once_locked) const
{
    return OwnedLedger::take(ledger,
                             {when_held, !manner_.is_durable(), std::move(once_locked)});
}

bool Run::outputs_are_there() const
{
    const OutputPaths& o = planned_.job.outputs;
    return std::filesystem::exists(o.disparity) && std::filesystem::exists(o.confidence) &&
           std::filesystem::exists(o.reasons);
}

void Run::do_tiles(Shard shard)
{
    const auto book = take(layout_.tiles_ledger(shard),
                           manner_.take_over ? WhenHeld::take_over : WhenHeld::refuse,
                           [&] { judge_earlier_shard(layout_, shard, manner_, fingerprint_); });
    (*book)->set_facts(as_facts(fingerprint_));
    match_tiles(planned_, layout_, shard, manner_, *book, progress_);
    give_back_freed_memory();
    for (const ledger::TileRow& row : (*book)->tiles(kMatchStage)) {
        result_.tiles_done += row.state == ledger::TileState::done;
        if (row.state == ledger::TileState::failed) {
            result_.failed.push_back(row);
        }
    }
}

void Run::do_assemble()
{
    // Of shards that end together, one assembles.
    const bool among_others = manner_.stage == RunStage::all && manner_.shard.has_value();
    const auto book =
        take(layout_.assemble_ledger(), among_others ? WhenHeld::give_way : WhenHeld::refuse);
    if (!book) {
        return;
    }
    const TilesOfRun tiles = tiles_of_run(planned_, layout_, shard_count());
    if (!tiles.missing.empty()) {
        if (among_others) {
            spdlog::info("{}; the last shard to finish assembles", tiles.missing);
            return;
        }
        throw io::ConfigError(
            fmt::format("{} cannot be assembled: {}", layout_.root.string(), tiles.missing));
    }
    result_.failed = tiles.failed;
    result_.tiles_done = tiles.done;
    remove_leftovers(planned_.job.outputs);
    if (is_assembled(*book, tiles.failed.size(), tiles.done)) {
        spdlog::info("everything is done already");
    } else {
        result_.summary = assemble(planned_, layout_, tiles, *book);
        finish(*book, tiles);
    }
    if (tiles.failed.empty() && manner_.is_durable()) {
        std::error_code none;
        std::filesystem::remove_all(layout_.work(), none);
    }
}

// Parts of outputs that killed processes left: with the ledger of this stage, nobody else is
// at work on them.
void Run::remove_leftovers(const OutputPaths& o) const
{
    for (const auto& path : o.files()) {
        if (manner_.is_durable()) {
            io::remove_unpublished(path.string());
        }
    }
}

// What stands beside the rasters, then the sign that all is there.
void Run::finish(const OwnedLedger& book, const TilesOfRun& tiles)
{
    if (!manner_.is_durable()) {
        return;
    }
    ledger::Facts defines = fingerprint_;
    defines.merge(pixels_in(ledger::read_ledger(layout_.coarse_ledger()).facts));
    const auto record = run_record(planned_, layout_, result_.summary.value(), defines, book);
    if (!manner_.used_yaml.empty()) {
        io::write_text_file((layout_.root / "config.used.yaml").string(), manner_.used_yaml);
    }
    publish_geometry(planned_.job, layout_);
    io::write_text_file((layout_.root / "run.json").string(), record.dump(2) + "\n");
    mark_assembled(book, tiles.failed.size(), tiles.done);
    write_report(layout_);
}

} // namespace

RunResult run_job(const PlannedJob& planned, const RunManner& manner, const Progress& progress)
{
    const auto threads = static_cast<std::size_t>(planned.budget.threads);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    tbb::task_arena arena(planned.budget.threads);
    return arena.execute([&] {
        std::optional<io::ScratchFolder> hidden;
        if (!manner.is_durable()) {
            hidden.emplace(folder_of(planned.job.outputs.disparity));
        }
        const RunLayout layout{hidden ? hidden->path() : manner.folder};
        return Run(planned, manner, layout, progress).carry_out();
    });
}

MatchSummary run_job(const PlannedJob& planned,
                     const std::function<void(int done, int all)>& progress)
{
    const RunResult result =
        run_job(planned, RunManner{}, [&](const TileProgress& p) { progress(p.done, p.all); });
    if (!result.failed.empty()) {
        throw FailedTiles(failure_sentence(result));
    }
    return result.summary.value();
}

std::string failure_sentence(const RunResult& result)
{
    const std::size_t failed = result.failed.size();
    std::string list;
    for (std::size_t i = 0; i < std::min(failed, kFailuresShown); ++i) {
        const ledger::TileRow& row = result.failed[i];
        list += fmt::format("{}rows {}-{}, columns {}-{} ({})", i > 0 ? "; " : "", row.rect.row,
                            row.rect.row_end() - 1, row.rect.col, row.rect.col_end() - 1,
                            row.reason);
    }
    return fmt::format("{} of {} tiles failed: {}{}", failed,
                       failed + static_cast<std::size_t>(result.tiles_done), list,
                       failed > kFailuresShown ? "; and more" : "");
}

} // namespace hsgm::pipeline
