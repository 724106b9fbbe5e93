#include "tests/device_stand_in/meetings.h"

#include <algorithm>
#include <bit>
#include <cstring>

// Compiled without the thread sanitizer: to it, this file is the machine, not the program.

namespace hsgm::stand_in {

namespace {

bool same(const Here& a, const Here& b)
{
    return a.line() == b.line() && std::strcmp(a.file_name(), b.file_name()) == 0;
}

bool names(unsigned mask, int lane)
{
    return (mask >> lane & 1U) != 0;
}

// Votes and minimum over the lanes of a meeting.
struct Sum {
    std::uint64_t any = 0;
    std::uint64_t all = 1;
    std::uint64_t ballot = 0;
    std::uint64_t minimum = ~std::uint64_t{0};
};

Sum sum_of(const Warp& warp, unsigned mask)
{
    Sum sum;
    for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const std::uint64_t value = warp.lanes[lane]->value;
        const std::uint64_t bit = value != 0 ? 1 : 0;
        sum.any |= bit;
        sum.all &= bit;
        sum.ballot |= bit << lane;
        sum.minimum = std::min(sum.minimum, value);
    }
    return sum;
}

std::uint64_t result_for(const DeviceThread& thread, const Sum& sum)
{
    switch (thread.collective) {
    case Collective::sync:
        return 0;
    case Collective::shuffle:
        return thread.warp->lanes[std::size_t(thread.source_lane)]->value;
    case Collective::any:
        return sum.any;
    case Collective::all:
        return sum.all;
    case Collective::ballot:
        return sum.ballot;
    case Collective::minimum:
        break;
    }
    return sum.minimum;
}

std::string complaint_about(const DeviceThread& thread, const DeviceThread* other)
{
    if (other == nullptr) {
        return "the mask at " + name(thread.here) + " names a lane that is not there";
    }
    if (other->waiting == Waiting::threads) {
        return "a lane waits at the barrier " + name(other->here) +
               " while its warp meets at " + name(thread.here);
    }
    if (other->waiting == Waiting::lanes &&
        (!same(other->here, thread.here) || other->mask != thread.mask ||
         other->collective != thread.collective)) {
        return "lanes of a warp meet at different places: " + name(other->here) + " and " +
               name(thread.here);
    }
    return "";
}

} // namespace

std::string name(const Here& here)
{
    const std::string file = here.file_name();
    const auto slash = file.rfind('/');
    return file.substr(slash == std::string::npos ? 0 : slash + 1) + ":" +
           std::to_string(here.line());
}

Meeting meet_at_collective(DeviceThread& thread)
{
    if (!names(thread.mask, thread.lane)) {
        return {false, "a lane calls a collective at " + name(thread.here) +
                           " whose mask does not name it"};
    }
    if (thread.collective == Collective::shuffle && !names(thread.mask, thread.source_lane)) {
        return {false, "a shuffle at " + name(thread.here) + " reads a lane outside its mask"};
    }
    bool complete = true;
    for (int lane = 0; lane < kLanes; ++lane) {
        if (names(thread.mask, lane)) {
            const DeviceThread* const other = thread.warp->lanes[std::size_t(lane)];
            const std::string complaint = complaint_about(thread, other);
            if (!complaint.empty()) {
                return {false, complaint};
            }
            complete = complete && other->waiting == Waiting::lanes;
        }
    }
    if (!complete) {
        return {};
    }
    const Sum sum = sum_of(*thread.warp, thread.mask);
    for (unsigned rest = thread.mask; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        DeviceThread& one = *thread.warp->lanes[lane];
        one.result = result_for(one, sum);
        one.waiting = Waiting::nothing;
    }
    return {true, ""};
}

Meeting meet_at_barrier(DeviceThread& thread)
{
    Block& block = *thread.block;
    if (block.finished > 0) {
        return {false, "a thread waits at the barrier " + name(thread.here) +
                           ", but others have left the kernel"};
    }
    if (++block.waiting < block.threads.size()) {
        return {};
    }
    const DeviceThread& first = *block.threads.front();
    std::uint64_t any = 0;
    std::uint64_t all = 1;
    std::uint64_t count = 0;
    for (const auto& other : block.threads) {
        if (!same(other->here, first.here) || other->barrier != first.barrier) {
            return {false, "threads of a block wait at different barriers: " +
                               name(first.here) + " and " + name(other->here)};
        }
        any |= other->value;
        all &= other->value;
        count += other->value;
    }
    block.waiting = 0;
    for (const auto& other : block.threads) {
        other->waiting = Waiting::nothing;
        other->result = other->barrier == Barrier::any   ? any
                        : other->barrier == Barrier::all ? all
                                                         : count;
    }
    return {true, ""};
}

} // namespace hsgm::stand_in
