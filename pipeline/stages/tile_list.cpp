#include "pipeline/stages/tile_list.h"

#include "io/error.h"
#include "pipeline/stages/tile_stage.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>

namespace hsgm::pipeline {

namespace {

using ledger::TileEvent;
using ledger::TileRow;
using ledger::TileState;
using tiling::Rect;

constexpr int kDeathsOfASuspect = 2;

std::shared_ptr<FirstPassPart> open_or_make(const PlannedJob& planned, const Rect& band,
                                            const std::filesystem::path& folder)
{
    std::error_code error;
    if (std::filesystem::exists(folder, error)) {
        try {
            return std::make_shared<FirstPassPart>(planned.shape, band, folder,
                                                   io::ScratchLife::existing);
        } catch (const io::StorageError&) {
            // Made by a process that was killed meanwhile, or damaged: its rows will not
            // agree with the new files, and so be done again.
            std::filesystem::remove_all(folder, error);
        }
    }
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw io::StorageError("Cannot make the folder " + folder.string() + ": " +
                               error.message() + ".");
    }
    return std::make_shared<FirstPassPart>(planned.shape, band, folder, io::ScratchLife::kept);
}

// Of the rows that are done, those whose results are there. The others are pending again.
std::vector<Rect> verified(ledger::Ledger& ledger, const std::vector<TileRow>& rows,
                           const ShardParts& parts)
{
    std::vector<Rect> done;
    std::vector<TileEvent> lost;
    for (const TileRow& row : rows) {
        if (row.state != TileState::done) {
            continue;
        }
        if (parts.holds(row)) {
            done.push_back(row.rect);
            continue;
        }
        TileEvent event;
        event.stage = kMatchStage;
        event.rect = row.rect;
        event.reason = "the stored results do not have its checksum";
        lost.push_back(event);
    }
    if (!lost.empty()) {
        spdlog::warn("stored results of {} tiles do not have their checksums; they are matched "
                     "again",
                     lost.size());
        ledger.commit(lost);
    }
    return done;
}

std::vector<Rect> near(const Rect& tile, const std::vector<Rect>& done)
{
    std::vector<Rect> found;
    std::copy_if(done.begin(), done.end(), std::back_inserter(found),
                 [&](const Rect& rect) { return !intersect(rect, tile).empty(); });
    return found;
}

} // namespace

ShardParts::ShardParts(const PlannedJob& planned, const RunLayout& layout, tiling::Shard shard,
                       int own_part)
    : own_part_(own_part)
{
    const Rect band = band_of(planned.shape.left, shard);
    own_ = open_or_make(planned, band, layout.part(shard, own_part));
    for (int number = 0; number < own_part; ++number) {
        try {
            earlier_[number] = std::make_unique<FirstPassPart>(
                planned.shape, band, layout.part(shard, number), io::ScratchLife::existing);
        } catch (const io::StorageError&) {
            earlier_[number] = nullptr; // nothing of it was recorded, or it is lost
        }
    }
}

const FirstPassPart* ShardParts::part(int number) const
{
    if (number == own_part_) {
        return own_.get();
    }
    const auto found = earlier_.find(number);
    return found == earlier_.end() ? nullptr : found->second.get();
}

bool ShardParts::holds(const TileRow& row) const
{
    const FirstPassPart* holder = part(row.part);
    return holder != nullptr && holder->checksum(row.rect) == row.checksum;
}

std::vector<ListedTile> list_tiles(const PlannedJob& planned, const Rect& band,
                                   ledger::Ledger& ledger, const ShardParts& parts)
{
    if (band.empty()) {
        return {};
    }
    const std::vector<Rect> done = verified(ledger, ledger.tiles(kMatchStage), parts);
    const tiling::TilePlan plan(band.size(), planned.budget.tile_size_px);
    std::vector<Rect> rest;
    for (const int tile : tiling::tile_sequence(plan, planned.job.run.order)) {
        Rect core = plan.core(tile);
        core.row += band.row;
        const Rect missing = tiling::bounds_of_rest(core, near(core, done));
        if (!missing.empty()) {
            rest.push_back(missing);
        }
    }
    ledger.plan(kMatchStage, rest);
    std::vector<ListedTile> tiles;
    for (const TileRow& row : ledger.tiles(kMatchStage)) {
        if (row.state == TileState::pending) {
            tiles.push_back({row.rect, row.deaths >= kDeathsOfASuspect, ""});
        }
    }
    return tiles;
}

} // namespace hsgm::pipeline
