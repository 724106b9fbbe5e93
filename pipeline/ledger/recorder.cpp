#include "pipeline/ledger/recorder.h"

#include <algorithm>
#include <utility>

namespace hsgm::ledger {

namespace {

double wall_clock_s()
{
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch())
        .count();
}

} // namespace

Recorder::Recorder(Ledger& ledger, std::function<void()> make_durable,
                   std::chrono::milliseconds period)
    : ledger_(ledger), make_durable_(std::move(make_durable)), period_(period),
      wall_at_start_s_(wall_clock_s()), thread_([this] { work(); })
{
}

Recorder::~Recorder()
{
    {
        const std::scoped_lock lock(mutex_);
        stop_ = true;
        wake_.notify_all();
    }
    thread_.join();
}

double Recorder::time_of(Clock::time_point moment) const
{
    return wall_at_start_s_ + std::chrono::duration<double>(moment - start_).count();
}

void Recorder::rethrow() const
{
    if (failure_) {
        std::rethrow_exception(failure_);
    }
}

void Recorder::add(TileEvent event)
{
    const std::scoped_lock lock(mutex_);
    rethrow();
    waiting_.push_back(std::move(event));
    wake_.notify_all();
}

void Recorder::flush()
{
    std::unique_lock lock(mutex_);
    hurry_ = true;
    wake_.notify_all();
    idle_.wait(lock, [this] { return failure_ || (waiting_.empty() && !committing_); });
    hurry_ = false;
    rethrow();
}

void Recorder::work()
{
    std::unique_lock lock(mutex_);
    Clock::time_point next = Clock::now();
    while (true) {
        wake_.wait(lock, [this] { return stop_ || !waiting_.empty(); });
        wake_.wait_until(lock, next, [this] { return stop_ || hurry_; });
        if (stop_) {
            return;
        }
        std::vector<TileEvent> events;
        events.swap(waiting_);
        committing_ = true;
        lock.unlock();
        std::exception_ptr failure;
        try {
            const bool done = std::any_of(events.begin(), events.end(), [](const TileEvent& e) {
                return e.state == TileState::done;
            });
            if (done && make_durable_) {
                make_durable_();
            }
            ledger_.commit(events);
        } catch (...) {
            failure = std::current_exception();
        }
        next = Clock::now() + period_;
        lock.lock();
        committing_ = false;
        failure_ = failure;
        idle_.notify_all();
        if (failure_) {
            return;
        }
    }
}

} // namespace hsgm::ledger
