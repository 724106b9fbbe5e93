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
};

/// Anything that matches tiles. All kinds give the same bits. A worker serves one tile at a
/// time; the graph asks each from one thread at once, not always the same one.
class MatchWorker {
public:
    virtual ~MatchWorker() = default;
    /// For logs: "cpu 0".
    virtual std::string name() const = 0;
    virtual matcher::TileMatch match(const TileTask& task) = 0;
};

/// Matches on the processor; the windows of its tile are shared out to the TBB arena.
class CpuWorker final : public MatchWorker {
public:
    CpuWorker(int number, const matcher::Matcher& matcher,
              const matcher::CoarseSolution& coarse)
        : number_(number), matcher_(matcher), coarse_(coarse)
    {
    }
    std::string name() const override { return "cpu " + std::to_string(number_); }
    matcher::TileMatch match(const TileTask& task) override
    {
        return matcher_.match_tile(task.core, task.images, coarse_);
    }

private:
    int number_;
    const matcher::Matcher& matcher_;
    const matcher::CoarseSolution& coarse_;
};

} // namespace hsgm::pipeline
