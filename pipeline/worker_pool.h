#pragma once

#include "pipeline/match_worker.h"

#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace hsgm::pipeline {

/// What came of one attempt at a tile.
struct MatchOutcome {
    int tile = 0;
    std::string worker; ///< empty where none was reached
    std::chrono::steady_clock::time_point started{};
    double seconds = 0;
    matcher::TileMatch match; ///< where there is no error
    std::exception_ptr error;
};

struct PoolOptions {
    /// A tile that takes longer is given up and counts as failed; 0: no limit.
    double time_limit_s = 0;
    /// A worker that does not come back within so long after that is left behind.
    double grace_s = 10;
};

/// All workers have been left behind: nothing can be matched any more.
class NoWorkerLeft : public std::runtime_error {
    using runtime_error::runtime_error;
};

/// A thread for each worker; all pull from one queue, so fast and slow ones are kept busy
/// alike. A worker that fails at three tiles in a row is set aside while another one works.
class WorkerPool {
public:
    explicit WorkerPool(std::span<const std::shared_ptr<MatchWorker>> workers,
                        PoolOptions options = {});
    /// Waits for the workers, but not for those left behind. Every task must have come back.
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    /// Queues a task. `deliver` is called once, from some other thread, whatever happens; with
    /// Interrupted when the process is asked to stop meanwhile, and NoWorkerLeft.
    void submit(std::shared_ptr<const TileTask> task,
                std::function<void(MatchOutcome)> deliver);

    /// Workers that still take tiles.
    int usable() const;

private:
    struct State;
    std::shared_ptr<State> state_;
};

} // namespace hsgm::pipeline
