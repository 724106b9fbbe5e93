#include "pipeline/stages/assemble_stage.h"

#include "pipeline/error.h"
#include "pipeline/freed_memory.h"
#include "pipeline/stages/pair_stage.h"
#include "pipeline/stages/pictures_stage.h"
#include "pipeline/stages/satellite_stage.h"
#include "pipeline/stages/tile_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace hsgm::pipeline {

namespace {

using ledger::TileRow;
using ledger::TileState;

// What keeps a shard from being assembled; empty: nothing.
std::string missing_in(const PlannedJob& planned, const RunLayout& layout,
                       const TilesOfRun::OfShard& of)
{
    const tiling::Rect band = band_of(planned.shape.left, of.shard);
    if (band.empty()) {
        return "";
    }
    if (!std::filesystem::exists(layout.tiles_ledger(of.shard))) {
        return fmt::format("shard {}/{} has not begun", of.shard.index, of.shard.count);
    }
    const auto open = std::count_if(of.tiles.begin(), of.tiles.end(), [](const TileRow& row) {
        return row.state == TileState::pending || row.state == TileState::running;
    });
    std::vector<tiling::Rect> known;
    for (const TileRow& row : of.tiles) {
        known.push_back(row.rect);
    }
    if (open > 0 || !tiling::bounds_of_rest(band, known).empty()) {
        return fmt::format("shard {}/{} is not finished: {} tiles wait", of.shard.index,
                           of.shard.count, open);
    }
    return "";
}

} // namespace

TilesOfRun tiles_of_run(const PlannedJob& planned, const RunLayout& layout, int count)
{
    TilesOfRun run;
    for (int index = 0; index < count; ++index) {
        TilesOfRun::OfShard of{{index, count}, {}};
        const auto path = layout.tiles_ledger(of.shard);
        if (std::filesystem::exists(path)) {
            of.tiles = ledger::read_ledger(path).tiles;
            std::erase_if(of.tiles,
                          [](const TileRow& row) { return row.stage != kMatchStage; });
        }
        for (const TileRow& row : of.tiles) {
            run.done += row.state == TileState::done;
            if (row.state == TileState::failed) {
                run.failed.push_back(row);
            }
        }
        if (run.missing.empty()) {
            run.missing = missing_in(planned, layout, of);
        }
        run.shards.push_back(std::move(of));
    }
    return run;
}

MatchSummary assemble(const PlannedJob& planned, const RunLayout& layout,
                      const TilesOfRun& tiles, const OwnedLedger& book)
{
    const tiling::Rect whole = rect_of(planned.shape.left);
    const OutputPaths& outputs = planned.job.outputs;
    MatchSummary summary;
    book.record("refine", whole, [&] {
        FirstPass results(planned.shape);
        for (const auto& of : tiles.shards) {
            add_results(planned, layout, of.shard, of.tiles, results);
        }
        const auto images =
            open_images(planned, layout, ledger::read_ledger(layout.coarse_ledger()).facts);
        summary = refine_and_write(results, *images, planned.shape, planned.job, planned.geo);
    });
    const auto then = [&](const char* stage, const std::function<void()>& work) {
        give_back_freed_memory(); // of the stage before
        book.record(stage, whole, work);
    };
    if (planned.job.satellite) {
        then("dsm", [&] { summary.dsm = write_satellite_heights(planned.job); });
    }
    if (!outputs.hillshade.empty()) {
        then("hillshade", [&] { write_hillshade_of(outputs); });
    }
    if (!outputs.disparity_picture.empty()) {
        then("pictures", [&] { write_pictures_of(outputs); });
    }
    give_back_freed_memory();
    return summary;
}

} // namespace hsgm::pipeline
