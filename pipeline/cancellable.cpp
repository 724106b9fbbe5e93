#include "pipeline/cancellable.h"

#include "pipeline/error.h"

#include <condition_variable>
#include <thread>

namespace hsgm::pipeline {

bool Cancellable::run(const std::function<void()>& work)
{
    tbb::task_group_context context;
    {
        const std::scoped_lock lock(mutex_);
        if (cancelled_) {
            return false;
        }
        running_ = &context;
    }
    const auto end = [this] {
        const std::scoped_lock lock(mutex_);
        running_ = nullptr;
        return cancelled_;
    };
    try {
        tbb::task_group group(context);
        group.run_and_wait(work);
    } catch (...) {
        end();
        throw;
    }
    return !end();
}

void Cancellable::cancel()
{
    const std::scoped_lock lock(mutex_);
    cancelled_ = true;
    if (running_ != nullptr) {
        running_->cancel_group_execution();
    }
}

void run_until_stopped(const std::function<void()>& work)
{
    Cancellable cancellable;
    std::mutex mutex;
    std::condition_variable ended;
    bool over = false;
    std::jthread watcher([&] {
        std::unique_lock lock(mutex);
        while (!ended.wait_for(lock, std::chrono::milliseconds(50), [&] { return over; })) {
            if (stop_is_requested()) {
                cancellable.cancel();
                return;
            }
        }
    });
    const auto stop_watching = [&] {
        const std::scoped_lock lock(mutex);
        over = true;
        ended.notify_all();
    };
    try {
        cancellable.run(work);
    } catch (...) {
        stop_watching();
        throw;
    }
    stop_watching();
    check_stop();
}

} // namespace hsgm::pipeline
