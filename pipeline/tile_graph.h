#pragma once

#include "pipeline/match_worker.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace hsgm::pipeline {

/// The three things that happen to a tile. `read` may run side by side for several tiles;
/// `write` runs for one tile at a time, in the order in which tiles are finished.
struct TileSteps {
    std::function<TileTask(int tile)> read;
    std::function<void(int tile, matcher::TileMatch)> write;
};

/// Sends the tiles of `sequence` through read, match and write:
///
///     tiles -> limiter -> read -> match (any free worker) -> write -+
///                 ^                                                 |
///                 +---------------- one more may start -------------+
///
/// At most `tiles_in_flight` tiles are between limiter and write, which bounds memory.
/// Returns when all are written; the first exception of a step stops the rest and is
/// thrown from here. Call it inside the TBB arena whose threads it shall use.
void run_tiles(std::span<const int> sequence, const TileSteps& steps,
               std::span<const std::unique_ptr<MatchWorker>> workers, int tiles_in_flight);

} // namespace hsgm::pipeline
