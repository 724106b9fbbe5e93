#pragma once

#include "pipeline/stages/owned_ledger.h"
#include "pipeline/stages/plan_stage.h"
#include "pipeline/stages/refine_stage.h"
#include "pipeline/stages/run_layout.h"

#include <string>
#include <vector>

namespace hsgm::pipeline {

/// What the ledgers of all shards say of their tiles.
struct TilesOfRun {
    struct OfShard {
        tiling::Shard shard;
        std::vector<ledger::TileRow> tiles;
    };
    std::vector<OfShard> shards;
    std::vector<ledger::TileRow> failed;
    int done = 0;
    /// Why the image cannot be assembled yet: "shard 1/3 has not begun"; empty: it can.
    std::string missing;
};

/// Reads the ledgers of the run's shards, as many as `count`.
TilesOfRun tiles_of_run(const PlannedJob& planned, const RunLayout& layout, int count);

/// The last stage: second pass over all shards' results, outputs, hillshade and pictures, each
/// with a row in the ledger. Outputs get their names when all of them are whole.
MatchSummary assemble(const PlannedJob& planned, const RunLayout& layout,
                      const TilesOfRun& tiles, const OwnedLedger& book);

} // namespace hsgm::pipeline
