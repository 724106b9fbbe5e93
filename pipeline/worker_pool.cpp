#include "pipeline/worker_pool.h"

#include "pipeline/error.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

namespace hsgm::pipeline {

namespace {

using Clock = std::chrono::steady_clock;
constexpr int kFailuresInARow = 3;
constexpr auto kWatchPeriod = std::chrono::milliseconds(50);

double seconds_since(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Order {
    std::shared_ptr<const TileTask> task;
    std::function<void(MatchOutcome)> deliver;
};

struct Seat {
    std::shared_ptr<MatchWorker> worker;
    std::thread thread;
    std::optional<Order> order; // at work on
    Clock::time_point started{};
    std::exception_ptr cancelled; // why it was asked to give up
    int failures_in_a_row = 0;
    bool set_aside = false;
    bool lost = false;
};

MatchOutcome failure(const Order& order, std::exception_ptr error)
{
    MatchOutcome outcome;
    outcome.tile = order.task->index;
    outcome.error = std::move(error);
    return outcome;
}

} // namespace

// Shared with the threads, because one that is left behind outlives the pool.
struct WorkerPool::State {
    PoolOptions options;
    mutable std::mutex mutex;
    std::condition_variable changed;
    std::deque<Order> queue;
    std::vector<std::unique_ptr<Seat>> seats;
    std::thread watcher;
    bool closing = false;
    bool stopping = false; // the process was asked to stop: no more tiles are begun

    bool is_usable(const Seat& seat) const { return !seat.lost && !seat.set_aside; }
    int count_usable() const
    {
        return static_cast<int>(std::count_if(seats.begin(), seats.end(),
                                              [&](const auto& s) { return is_usable(*s); }));
    }
    std::optional<Order> take_order(const Seat& seat);
    void serve(Seat& seat);
    void count_failure(Seat& seat, bool failed);
    void watch();
    void look_after(Seat& seat);
    void give_up(Seat& seat, std::exception_ptr why);
    void answer_for(const Order& order, MatchOutcome outcome);
    void answer_for_queue();
    std::vector<std::function<void()>> answers; // of the watcher, to be given without the lock
};

std::optional<Order> WorkerPool::State::take_order(const Seat& seat)
{
    if (!is_usable(seat) || stopping) {
        return std::nullopt;
    }
    const bool alone = count_usable() == 1;
    const auto mine = std::find_if(queue.begin(), queue.end(), [&](const Order& order) {
        return alone || order.task->avoid != seat.worker->name();
    });
    if (mine == queue.end()) {
        return std::nullopt;
    }
    Order order = std::move(*mine);
    queue.erase(mine);
    return order;
}

void WorkerPool::State::count_failure(Seat& seat, bool failed)
{
    seat.failures_in_a_row = failed ? seat.failures_in_a_row + 1 : 0;
    if (seat.failures_in_a_row >= kFailuresInARow && !seat.set_aside && count_usable() > 1) {
        seat.set_aside = true;
        spdlog::warn("worker {} failed at {} tiles in a row and gets no more",
                     seat.worker->name(), seat.failures_in_a_row);
    }
}

void WorkerPool::State::serve(Seat& seat)
{
    std::unique_lock lock(mutex);
    while (true) {
        std::optional<Order> order;
        changed.wait(lock, [&] {
            order = take_order(seat);
            return order.has_value() || closing;
        });
        if (!order) {
            return;
        }
        seat.order = order;
        seat.started = Clock::now();
        seat.cancelled = nullptr;
        lock.unlock();
        MatchOutcome outcome = failure(*order, nullptr);
        try {
            outcome.match = seat.worker->match(*order->task);
        } catch (...) {
            outcome.error = std::current_exception();
        }
        lock.lock();
        if (seat.lost) {
            return; // somebody else answered for it
        }
        outcome.worker = seat.worker->name();
        outcome.started = seat.started;
        outcome.seconds = seconds_since(seat.started);
        if (outcome.error && seat.cancelled) {
            outcome.error = seat.cancelled;
        }
        seat.order.reset();
        count_failure(seat, outcome.error != nullptr);
        lock.unlock();
        order->task.reset();
        order->deliver(std::move(outcome));
        lock.lock();
        changed.notify_all();
    }
}

void WorkerPool::State::answer_for(const Order& order, MatchOutcome outcome)
{
    answers.emplace_back([deliver = order.deliver, result = std::move(outcome)]() mutable {
        deliver(std::move(result));
    });
}

// What waits when nobody will come for it any more.
void WorkerPool::State::answer_for_queue()
{
    std::exception_ptr end;
    if (stopping) {
        end = std::make_exception_ptr(Interrupted("interrupted"));
    } else if (count_usable() == 0) {
        end = std::make_exception_ptr(NoWorkerLeft(
            "every worker hangs past the time limit; what is done is recorded, and --resume "
            "goes on"));
    } else {
        return;
    }
    for (const Order& order : queue) {
        answer_for(order, failure(order, end));
    }
    queue.clear();
}

// May be called again and again: the worker may have been between two tiles.
void WorkerPool::State::give_up(Seat& seat, std::exception_ptr why)
{
    if (!seat.cancelled) {
        seat.cancelled = std::move(why);
    }
    seat.worker->cancel();
}

// Cancels what takes too long, and stops waiting where that does not help.
void WorkerPool::State::look_after(Seat& seat)
{
    if (!seat.order || seat.lost) {
        return;
    }
    if (stopping) {
        give_up(seat, std::make_exception_ptr(Interrupted("interrupted")));
    }
    const double taken_s = seconds_since(seat.started);
    if (options.time_limit_s <= 0 || taken_s <= options.time_limit_s) {
        return;
    }
    give_up(seat, std::make_exception_ptr(std::runtime_error(fmt::format(
                      "it took longer than the limit of {:g} s", options.time_limit_s))));
    if (taken_s <= options.time_limit_s + options.grace_s) {
        return;
    }
    seat.lost = true;
    spdlog::warn("worker {} hangs and is left behind", seat.worker->name());
    MatchOutcome outcome = failure(*seat.order, seat.cancelled);
    outcome.worker = seat.worker->name();
    outcome.started = seat.started;
    outcome.seconds = taken_s;
    answer_for(*seat.order, std::move(outcome));
}

void WorkerPool::State::watch()
{
    std::unique_lock lock(mutex);
    while (!closing) {
        stopping = stop_is_requested();
        for (const auto& seat : seats) {
            look_after(*seat);
        }
        answer_for_queue();
        std::vector<std::function<void()>> due;
        due.swap(answers);
        lock.unlock();
        for (const auto& answer : due) {
            answer();
        }
        lock.lock();
        changed.wait_for(lock, kWatchPeriod, [&] { return closing; });
    }
}

WorkerPool::WorkerPool(std::span<const std::shared_ptr<MatchWorker>> workers,
                       PoolOptions options)
    : state_(std::make_shared<State>())
{
    state_->options = options;
    for (const auto& worker : workers) {
        state_->seats.push_back(std::make_unique<Seat>());
        state_->seats.back()->worker = worker;
    }
    for (const auto& seat : state_->seats) {
        seat->thread = std::thread([state = state_, &s = *seat] { state->serve(s); });
    }
    state_->watcher = std::thread([state = state_] { state->watch(); });
}

WorkerPool::~WorkerPool()
{
    {
        const std::scoped_lock lock(state_->mutex);
        state_->closing = true;
        state_->changed.notify_all();
    }
    state_->watcher.join();
    for (const auto& seat : state_->seats) {
        if (seat->lost) {
            seat->thread.detach();
        } else {
            seat->thread.join();
        }
    }
}

void WorkerPool::submit(std::shared_ptr<const TileTask> task,
                        std::function<void(MatchOutcome)> deliver)
{
    const std::scoped_lock lock(state_->mutex);
    state_->queue.push_back({std::move(task), std::move(deliver)});
    state_->changed.notify_all();
}

int WorkerPool::usable() const
{
    const std::scoped_lock lock(state_->mutex);
    return state_->count_usable();
}

} // namespace hsgm::pipeline
