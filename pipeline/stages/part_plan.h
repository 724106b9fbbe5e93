#pragma once

#include "pipeline/stages/plan_stage.h"
#include "pipeline/stages/run_manner.h"

#include <cstdint>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// One process of a run that is shared out: the coarse stage, a shard, or the assembly.
struct PlannedPart {
    RunStage stage = RunStage::tiles;
    std::string name;              ///< "coarse", "tiles 0/3", "assemble"
    tiling::Rect rows;             ///< of the left image; all of them but for a shard
    int tiles = 0;                 ///< none but for a shard
    std::int64_t memory_bytes = 0; ///< an upper bound, as in the plan of a run in one process
    std::int64_t disk_bytes = 0; ///< written by this part, beside what the others have written
};

/// The parts of a run with so many shards, in the order in which they are carried out; nothing
/// here reads a pixel. A shard has no tile where there are more shards than pieces of 64 rows.
/// Throws std::invalid_argument for less than one shard.
std::vector<PlannedPart> plan_parts(const PlannedJob& planned, int shards);

} // namespace hsgm::pipeline
