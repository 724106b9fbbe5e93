#pragma once

#include "tests/device_stand_in/control.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace hsgm::stand_in {

/// The threads that could go on, in the order in which a schedule lets them. A ring that never
/// grows: threads of a kernel push here, and the thread sanitizer watches what they allocate.
template <typename Thread>
class ReadyList {
public:
    ReadyList(const Schedule& schedule, std::size_t most)
        : order_(schedule.order), state_(schedule.seed * 0x9E3779B97F4A7C15U + 1),
          ring_(most + 1)
    {
    }
    bool empty() const { return first_ == end_; }

    void push(Thread* thread)
    {
        ring_[end_] = thread;
        end_ = next(end_);
    }

    /// What the schedule picks changes places with the first, or the last.
    Thread* pop()
    {
        Thread* thread = nullptr;
        if (order_ == Order::lifo) {
            end_ = (end_ + ring_.size() - 1) % ring_.size();
            thread = ring_[end_];
        } else {
            std::swap(ring_[first_], ring_[choose()]);
            thread = ring_[first_];
            first_ = next(first_);
        }
        last_ = thread;
        return thread;
    }

    std::uint64_t random()
    {
        state_ ^= state_ << 13;
        state_ ^= state_ >> 7;
        state_ ^= state_ << 17;
        return state_;
    }

private:
    std::size_t next(std::size_t at) const { return at + 1 == ring_.size() ? 0 : at + 1; }

    std::size_t choose()
    {
        if (order_ == Order::random) {
            const std::size_t count = (end_ + ring_.size() - first_) % ring_.size();
            return (first_ + static_cast<std::size_t>(random() % count)) % ring_.size();
        }
        if (order_ == Order::warp_priority && last_ != nullptr) {
            for (std::size_t at = first_; at != end_; at = next(at)) {
                if (ring_[at]->warp == last_->warp) {
                    return at;
                }
            }
        }
        return first_;
    }

    Order order_;
    std::uint64_t state_;
    std::vector<Thread*> ring_;
    std::size_t first_ = 0;
    std::size_t end_ = 0;
    Thread* last_ = nullptr;
};

} // namespace hsgm::stand_in
