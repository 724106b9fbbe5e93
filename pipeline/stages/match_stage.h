#pragma once

#include "pipeline/stages/plan_stage.h"
#include "pipeline/stages/refine_stage.h"
#include "pipeline/stages/run_manner.h"
#include "pipeline/stages/tile_stage.h"

#include <functional>
#include <optional>
#include <vector>

namespace hsgm::pipeline {

/// What a call of `run_job` came to.
struct RunResult {
    /// Absent: nothing was assembled in this call, because that was not asked for, or other
    /// shards are still at work, or everything had been done before.
    std::optional<MatchSummary> summary;
    std::vector<ledger::TileRow> failed; ///< tiles that carry the reason failed_tile
    int tiles_done = 0;
};

/// Carries out a planned job, or the part of it that `manner` names, from its files to its
/// rasters, in an arena of its own. Failed tiles do not throw. Throws ConfigError where a run
/// cannot be resumed, StorageError where another process is at work on it, Interrupted, and
/// what the stages throw; whatever was done until then is recorded, and a run with a folder
/// can be resumed.
RunResult run_job(const PlannedJob& planned, const RunManner& manner, const Progress& progress);

/// The same without books, in one go: everything intermediate lives in a hidden folder beside
/// the outputs and goes away at the end, also after an error. Throws FailedTiles.
MatchSummary run_job(const PlannedJob& planned,
                     const std::function<void(int done, int all)>& progress);

/// "3 of 400 tiles failed: rows 0-255, columns 256-511 (reason); ..."
std::string failure_sentence(const RunResult& result);

} // namespace hsgm::pipeline
