#pragma once

#include "pipeline/tile_graph.h"

#include <atomic>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

// The flow graph without a matcher: workers that only count.
namespace hsgm::pipeline::testing {

class FakeWorker final : public MatchWorker {
public:
    explicit FakeWorker(std::function<void(int)> at_tile) : at_tile_(std::move(at_tile)) {}
    std::string name() const override { return "fake"; }
    matcher::TileMatch match(const TileTask& task) override
    {
        if (busy_.exchange(true)) {
            throw std::logic_error("one worker was given two tiles at once");
        }
        at_tile_(task.index);
        matcher::TileMatch result;
        result.core = task.core;
        busy_ = false;
        return result;
    }

private:
    std::function<void(int)> at_tile_;
    std::atomic<bool> busy_{false};
};

inline std::vector<std::unique_ptr<MatchWorker>>
fake_workers(int count, const std::function<void(int)>& at_tile)
{
    std::vector<std::unique_ptr<MatchWorker>> workers;
    for (int i = 0; i < count; ++i) {
        workers.push_back(std::make_unique<FakeWorker>(at_tile));
    }
    return workers;
}

/// A task that carries its number twice, so that a mix-up shows.
inline TileTask numbered_task(int tile)
{
    TileTask task;
    task.index = tile;
    task.core = {tile, 2 * tile, 1, 1};
    return task;
}

} // namespace hsgm::pipeline::testing
