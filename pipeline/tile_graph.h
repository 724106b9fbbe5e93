#pragma once

#include "pipeline/worker_pool.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace hsgm::pipeline {

/// What happens to a tile. `read` may run side by side for several tiles; `write` and `ended`
/// run for one tile at a time, in the order in which tiles are finished.
struct TileSteps {
    std::function<TileTask(int tile)> read;
    std::function<void(int tile, matcher::TileMatch)> write;
    /// Told of every tile after its `write`, or after `read` or the match failed, which then
    /// does not end the run. May be left out: then the first failure ends it. The outcome's
    /// match is gone.
    std::function<void(const MatchOutcome&)> ended;
};

/// Sends the tiles of `sequence` through read, match and write:
///
///     tiles -> limiter -> read -> match (any free worker) -> write -+
///                 ^                                                 |
///                 +---------------- one more may start -------------+
///
/// At most `tiles_in_flight` tiles are between limiter and write, which bounds memory.
/// Returns when all have been through. An exception of `write` or `ended`, Interrupted and
/// NoWorkerLeft stop the rest and are thrown from here. Call it inside the TBB arena whose
/// threads shall read and write.
void run_tiles(std::span<const int> sequence, const TileSteps& steps, WorkerPool& pool,
               int tiles_in_flight);

} // namespace hsgm::pipeline
