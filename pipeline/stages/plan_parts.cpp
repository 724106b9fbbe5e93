#include "pipeline/stages/plan_parts.h"

#include "pipeline/stages/first_pass.h"
#include "tiling/shard.h"

#include <algorithm>
#include <stdexcept>

namespace hsgm::pipeline {

namespace {

PlannedPart shard_part(const PlannedJob& planned, tiling::Shard shard)
{
    const Budget& budget = planned.budget;
    PlannedPart part;
    part.name = "tiles " + std::to_string(shard.index) + "/" + std::to_string(shard.count);
    part.rows = band_of(planned.shape.left, shard);
    if (part.rows.empty()) {
        return part;
    }
    part.tiles = tiling::TilePlan(part.rows.size(), budget.tile_size_px).count();
    // Every shard solves the coarsest level for itself.
    part.memory_bytes = std::max(budget.coarse_bytes, budget.tiles_bytes) + budget.held_bytes;
    part.disk_bytes = FirstPass::disk_bytes(planned.shape, part.rows.rows);
    return part;
}

} // namespace

std::vector<PlannedPart> plan_parts(const PlannedJob& planned, int shards)
{
    if (shards < 1) {
        throw std::invalid_argument("a run has at least one shard, not " +
                                    std::to_string(shards));
    }
    const Budget& budget = planned.budget;
    const tiling::Rect whole = rect_of(planned.shape.left);
    std::vector<PlannedPart> parts;
    parts.push_back({RunStage::coarse, "coarse", whole, 0,
                     budget.prepare_bytes + budget.held_bytes, budget.pyramid_disk_bytes});
    for (int index = 0; index < shards; ++index) {
        parts.push_back(shard_part(planned, {index, shards}));
    }
    parts.push_back({RunStage::assemble, "assemble", whole, 0,
                     budget.refine_bytes + budget.held_bytes, budget.output_disk_bytes});
    return parts;
}

} // namespace hsgm::pipeline
