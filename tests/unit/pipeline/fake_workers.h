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
    FakeWorker(int number, std::function<void(int)> at_tile)
        : number_(number), at_tile_(std::move(at_tile))
    {
    }
    std::string name() const override { return "fake " + std::to_string(number_); }
    matcher::TileMatch match(const TileTask& task) override
    {
        if (busy_.exchange(true)) {
            throw std::logic_error("one worker was given two tiles at once");
        }
        const struct Free {
            std::atomic<bool>& busy;
            ~Free() { busy = false; }
        } when_done{busy_};
        at_tile_(task.index);
        matcher::TileMatch result;
        result.core = task.core;
        return result;
    }

private:
    int number_;
    std::function<void(int)> at_tile_;
    std::atomic<bool> busy_{false};
};

using Workers = std::vector<std::shared_ptr<MatchWorker>>;

inline Workers fake_workers(int count, const std::function<void(int)>& at_tile)
{
    Workers workers;
    for (int i = 0; i < count; ++i) {
        workers.push_back(std::make_shared<FakeWorker>(i, at_tile));
    }
    return workers;
}

inline void run_tiles_with(std::span<const int> sequence, const TileSteps& steps,
                           const Workers& workers, int tiles_in_flight)
{
    WorkerPool pool(workers);
    run_tiles(sequence, steps, pool, tiles_in_flight);
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
