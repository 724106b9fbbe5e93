#pragma once

#include "matcher/matcher.h"

#include <memory>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// One tile on its way to a worker: its core and the images of its support, level by level.
struct TileTask {
    int index = 0;
    tiling::Rect core;
    std::vector<matcher::LevelImages> images;
    /// Name of the worker that failed at this tile before: another one shall try, where there
    /// is one.
    std::string avoid;
};

/// Anything that matches tiles. All kinds give the same bits. A worker serves one tile at a
/// time, on a thread that the pool gives it. What `match` throws fails the tile, not the run.
class MatchWorker {
public:
    virtual ~MatchWorker() = default;
    /// For logs and the ledger, different for each: "cpu 0".
    virtual std::string name() const = 0;
    virtual matcher::TileMatch match(const TileTask& task) = 0;
    /// Asks a `match` under way to give up soon, by an exception. From any thread, at any time.
    /// A worker that cannot is waited for, or left behind where it exceeds its time limit.
    virtual void cancel() {}
};

} // namespace hsgm::pipeline
