#pragma once

#include "pipeline/ledger/ledger.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace hsgm::ledger {

/// Records events in the background, several at a time, because every commit waits for the
/// disk. A tile is recorded as done only after `make_durable` has brought its results there.
/// Thread-safe.
class Recorder {
public:
    using Clock = std::chrono::steady_clock;

    /// Commits at most every `period`. `make_durable` runs on the recorder's thread before any
    /// commit that has a done tile, and sees all results stored before that tile's `add`.
    Recorder(Ledger& ledger, std::function<void()> make_durable,
             std::chrono::milliseconds period = std::chrono::milliseconds(250));
    /// Leaves unrecorded what `flush` has not seen to.
    ~Recorder();
    Recorder(const Recorder&) = delete;
    Recorder& operator=(const Recorder&) = delete;

    /// Throws what went wrong in the background: TakenOverError, StorageError.
    void add(TileEvent event);
    /// Returns when everything added before is recorded; throws as `add`.
    void flush();

    /// The time to record for a moment: what the machine's clock said when the recorder was
    /// made, and what has passed since by a clock that is never set.
    double time_of(Clock::time_point moment) const;

private:
    void work();
    void rethrow() const;

    Ledger& ledger_;
    std::function<void()> make_durable_;
    std::chrono::milliseconds period_;
    double wall_at_start_s_;
    Clock::time_point start_ = Clock::now();

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::condition_variable idle_;
    std::vector<TileEvent> waiting_;
    bool committing_ = false;
    bool hurry_ = false;
    bool stop_ = false;
    std::exception_ptr failure_;
    std::thread thread_; // last: it uses all of the above
};

} // namespace hsgm::ledger
