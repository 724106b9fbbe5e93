#pragma once

#include "pipeline/stages/first_pass.h"
#include "pipeline/stages/owned_ledger.h"
#include "pipeline/stages/pair_stage.h"
#include "pipeline/stages/plan_stage.h"
#include "pipeline/stages/run_layout.h"
#include "pipeline/stages/run_manner.h"

#include <functional>
#include <vector>

namespace hsgm::pipeline {

/// How far the tiles of a shard are.
struct TileProgress {
    int done = 0; ///< tiles, those that failed for good included
    int all = 0;
    int in_flight = 0;
    int failed = 0;
    std::int64_t pixels_done = 0; ///< in this process
    std::int64_t pixels_all = 0;  ///< that were missing when it began
};
using Progress = std::function<void(const TileProgress&)>;

/// Name of the stage in the ledger.
constexpr const char* kMatchStage = "match";

/// Matches the tiles of one shard that are not done yet, into the shard's scratch part. A tile
/// that fails is tried again by another worker, then alone; then it is recorded as failed, and
/// the rest goes on. Tiles that a process died at twice come last, alone. A tile is recorded as
/// done only when its results are on the disk (in a run with a folder).
///
/// Throws Interrupted, StorageError, TakenOverError and NoWorkerLeft; what was done until then
/// is recorded.
void match_tiles(const PlannedJob& planned, const RunLayout& layout, tiling::Shard shard,
                 const RunManner& manner, const OwnedLedger& book, const Progress& progress);

/// Opens the results of a shard for the second pass, as its ledger tells of them.
void add_results(const PlannedJob& planned, const RunLayout& layout, tiling::Shard shard,
                 const std::vector<ledger::TileRow>& tiles, FirstPass& results);

} // namespace hsgm::pipeline
