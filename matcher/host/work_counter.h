#pragma once

#include "matcher/statistics.h"

#include <atomic>

namespace hsgm::matcher::host {

/// Adds up the work of blocks that are solved by any number of threads: sums of whole
/// numbers, hence the same in every order.
class WorkCounter {
public:
    void add(const MatchStatistics& work)
    {
        windows_.fetch_add(work.windows, std::memory_order_relaxed);
        cells_.fetch_add(work.cells, std::memory_order_relaxed);
        path_steps_.fetch_add(work.path_steps, std::memory_order_relaxed);
    }
    /// Once the threads are done.
    MatchStatistics total() const
    {
        return {windows_.load(), cells_.load(), path_steps_.load()};
    }

private:
    std::atomic<std::int64_t> windows_{0};
    std::atomic<std::int64_t> cells_{0};
    std::atomic<std::int64_t> path_steps_{0};
};

} // namespace hsgm::matcher::host
