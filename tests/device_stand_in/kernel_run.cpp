#include "tests/device_stand_in/kernel_run.h"

#include "tests/device_stand_in/meetings.h"
#include "tests/device_stand_in/ready_list.h"
#include "tests/device_stand_in/sanitizers.h"

#include <algorithm>
#include <bit>
#include <deque>

// Compiled without the thread sanitizer: to it, this file is the machine, not the program.

namespace hsgm::stand_in {

Place place;

namespace {

constexpr std::byte kFresh{0xCD};   // shared memory before anybody wrote to it
constexpr std::size_t kMargin = 64; // forbidden bytes on both sides of it
constexpr std::size_t kMostZones = 64;

// One kernel on its way.
class Run {
public:
    Run(Index3 grid, Index3 block, std::size_t shared_bytes, const Schedule& schedule,
        const std::function<void()>& body)
        : grid_(grid), block_(block), shared_bytes_(shared_bytes), schedule_(schedule),
          body_(body), ready_(schedule, std::size_t{block.x} * block.y * block.z *
                                            std::size_t(schedule.resident_blocks))
    {
    }

    std::string all_blocks();

    std::uint64_t meet_lanes(Collective what, unsigned mask, std::uint64_t value, int lane,
                             const Here& here);
    int meet_threads(Barrier what, int predicate, const Here& here);
    void maybe_switch();
    Block& block() { return *current_->block; }

private:
    static void thread_main(void* run);
    void start(Block& block, unsigned number);
    void finish(Block& block);
    void pause();
    void fail(const std::string& sentence);
    void tell_stuck();

    Index3 grid_;
    Index3 block_;
    std::size_t shared_bytes_;
    Schedule schedule_;
    const std::function<void()>& body_;
    ReadyList<DeviceThread> ready_;
    std::vector<Block> blocks_; // their memory is there from before the start to the end
    std::vector<Block*> resident_;
    DeviceThread* current_ = nullptr;
    std::string failure_;
    char begin_ = 0; // objects that order the launch before the kernel before what follows
    char end_ = 0;
};

Run* run = nullptr;

// Fibers are dear to make; those of finished threads serve again. Not the same for the same
// thread of the next block: what one fiber does is in order to the thread sanitizer, and it
// would see no race between the two.
std::deque<std::unique_ptr<DeviceThread>> spare_threads;
constexpr std::size_t kSpareThreads = 97;

std::unique_ptr<DeviceThread> take_thread()
{
    if (spare_threads.size() < kSpareThreads) {
        return std::make_unique<DeviceThread>();
    }
    auto thread = std::move(spare_threads.front());
    spare_threads.pop_front();
    return thread;
}

void Run::thread_main(void* run_pointer)
{
    Run& self = *static_cast<Run*>(run_pointer);
    acquire(&self.begin_);
    self.body_();
    release(&self.end_);
    DeviceThread& thread = *self.current_;
    Block& block = *thread.block;
    thread.warp->lanes[std::size_t(thread.lane)] = nullptr;
    ++block.finished;
    if (block.waiting > 0) {
        self.fail("a thread leaves the kernel while others wait at a barrier");
    }
}

void Run::start(Block& block, unsigned number)
{
    block.index = {number % grid_.x, number / grid_.x % grid_.y, number / grid_.x / grid_.y};
    const std::size_t count = std::size_t{block_.x} * block_.y * block_.z;
    block.warps.resize((count + kLanes - 1) / kLanes);
    for (std::size_t i = 0; i < count; ++i) {
        auto thread = take_thread();
        const auto n = static_cast<unsigned>(i);
        thread->index = {n % block_.x, n / block_.x % block_.y, n / block_.x / block_.y};
        thread->lane = static_cast<int>(i % kLanes);
        thread->block = &block;
        thread->warp = &block.warps[i / kLanes];
        thread->waiting = Waiting::nothing;
        thread->barriers = 0;
        thread->warp_meetings = 0;
        thread->warp->lanes[i % kLanes] = thread.get();
        thread->fiber.prepare(&Run::thread_main, this);
        ready_.push(thread.get());
        block.threads.push_back(std::move(thread));
    }
    current_ = block.threads.front().get();
    std::byte* const shared = dynamic_shared();
    forbid_shared(shared - kMargin, kMargin);
    forbid_shared(shared + shared_bytes_, kMargin);
}

void Run::finish(Block& block)
{
    for (const Forbidden& zone : block.forbidden) {
        unpoison(zone.begin, zone.bytes);
        if (!std::all_of(zone.begin, zone.begin + zone.bytes,
                         [](std::byte b) { return b == kFresh; })) {
            fail("a thread wrote outside its array in shared memory");
        }
    }
    std::move(block.threads.begin(), block.threads.end(), std::back_inserter(spare_threads));
    block.threads.clear();
}

std::string Run::all_blocks()
{
    const unsigned count = grid_.x * grid_.y * grid_.z;
    blocks_.resize(count);
    for (Block& block : blocks_) {
        block.shared.assign(shared_bytes_ + 2 * kMargin + 16, kFresh);
        block.forbidden.reserve(kMostZones); // threads add to it, and may not allocate
    }
    release(&begin_);
    unsigned next = 0;
    while (failure_.empty() && (next < count || !resident_.empty())) {
        while (next < count && resident_.size() < std::size_t(schedule_.resident_blocks)) {
            resident_.push_back(&blocks_[next]);
            start(blocks_[next], schedule_.reversed_blocks ? count - 1 - next : next);
            ++next;
        }
        if (ready_.empty()) {
            tell_stuck();
            break;
        }
        current_ = ready_.pop();
        Block& block = *current_->block;
        place = {current_->index, block.index, block_, grid_};
        current_->fiber.resume();
        if (block.finished == block.threads.size()) {
            finish(block);
            std::erase(resident_, &block);
        }
    }
    for (Block* block : resident_) { // after a failure: threads that did not come to their end
        for (const auto& thread : block->threads) {
            thread->fiber.release(&end_);
        }
    }
    acquire(&end_);
    for (Block* block : resident_) {
        finish(*block);
    }
    return failure_;
}

void Run::fail(const std::string& sentence)
{
    if (failure_.empty()) {
        failure_ = sentence + " (block " + std::to_string(place.block.x) + ", thread " +
                   std::to_string(place.thread.x) + ")";
    }
}

// Lets others run. After a failure nobody goes on, and the paused fibers are forgotten.
void Run::pause()
{
    DeviceThread* const thread = current_;
    Fiber::pause();
    current_ = thread;
}

std::uint64_t Run::meet_lanes(Collective what, unsigned mask, std::uint64_t value, int lane,
                              const Here& here)
{
    DeviceThread& self = *current_;
    self.waiting = Waiting::lanes;
    self.collective = what;
    self.mask = mask;
    self.value = value;
    self.source_lane = lane;
    self.here = here;
    // Of the collectives, __syncwarp alone orders memory.
    void* const meeting = &self.warp->meeting[self.warp_meetings % 2];
    if (what == Collective::sync) {
        ++self.warp_meetings;
        release(meeting);
    }
    const Meeting found = meet_at_collective(self);
    if (found.complete) {
        for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
            ready_.push(self.warp->lanes[std::size_t(std::countr_zero(rest))]);
        }
    } else if (!found.complaint.empty()) {
        fail(found.complaint);
    }
    pause();
    if (what == Collective::sync) {
        acquire(meeting);
    }
    return self.result;
}

int Run::meet_threads(Barrier what, int predicate, const Here& here)
{
    DeviceThread& self = *current_;
    self.waiting = Waiting::threads;
    self.barrier = what;
    self.value = predicate != 0 ? 1 : 0;
    self.here = here;
    void* const meeting = &self.block->meeting[self.barriers++ % 2];
    release(meeting);
    const Meeting found = meet_at_barrier(self);
    if (found.complete) {
        for (const auto& thread : self.block->threads) {
            ready_.push(thread.get());
        }
    } else if (!found.complaint.empty()) {
        fail(found.complaint);
    }
    pause();
    acquire(meeting);
    return static_cast<int>(self.result);
}

void Run::maybe_switch()
{
    if (schedule_.order == Order::random && ready_.random() % 4 == 0) {
        ready_.push(current_);
        pause();
    }
}

void Run::tell_stuck()
{
    for (const Block* block : resident_) {
        for (const auto& thread : block->threads) {
            if (thread->waiting != Waiting::nothing) {
                fail("the kernel hangs: a thread waits for ever at " + name(thread->here));
                return;
            }
        }
    }
    fail("the kernel hangs");
}

} // namespace

bool in_kernel()
{
    return run != nullptr;
}

std::uint64_t meet_lanes(Collective what, unsigned mask, std::uint64_t value, int lane,
                         const Here& here)
{
    return run->meet_lanes(what, mask, value, lane, here);
}

int meet_threads(Barrier what, int predicate, const Here& here)
{
    return run->meet_threads(what, predicate, here);
}

void maybe_switch()
{
    if (run != nullptr) {
        run->maybe_switch();
    }
}

std::byte* dynamic_shared()
{
    std::byte* const data = run->block().shared.data() + kMargin;
    return data + (16 - std::bit_cast<std::uintptr_t>(data) % 16) % 16;
}

void forbid_shared(std::byte* begin, std::size_t bytes)
{
    auto& forbidden = run->block().forbidden;
    const bool known = std::any_of(forbidden.begin(), forbidden.end(),
                                   [begin](const Forbidden& z) { return z.begin == begin; });
    if (!known) {
        forbidden.push_back({begin, bytes});
        poison(begin, bytes);
    }
}

std::string run_kernel(Index3 grid, Index3 block, std::size_t shared_bytes,
                       const Schedule& schedule, const std::function<void()>& body)
{
    Run this_run(grid, block, shared_bytes, schedule, body);
    run = &this_run;
    const std::string failure = this_run.all_blocks();
    run = nullptr;
    return failure;
}

} // namespace hsgm::stand_in
