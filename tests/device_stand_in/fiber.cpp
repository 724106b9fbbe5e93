#include "tests/device_stand_in/fiber.h"

#include "tests/device_stand_in/sanitizers.h"

#include <boost/context/detail/fcontext.hpp>
#include <sys/mman.h>

#include <new>

// Compiled without the thread sanitizer: to it, this file is the machine, not the program.

namespace hsgm::stand_in {

namespace context = boost::context::detail;

namespace {

// Kernels keep little on the stack; sanitized builds keep more.
constexpr std::size_t kStackBytes = std::size_t{256} << 10;

Fiber* running = nullptr;
context::fcontext_t scheduler = nullptr;
[[maybe_unused]] const void* scheduler_stack = nullptr;
[[maybe_unused]] std::size_t scheduler_stack_bytes = 0;

} // namespace

struct Fiber::Switch {
    static void arrive_in_fiber([[maybe_unused]] Fiber& fiber)
    {
#if defined(__SANITIZE_ADDRESS__)
        __sanitizer_finish_switch_fiber(fiber.fake_stack_, &scheduler_stack,
                                        &scheduler_stack_bytes);
#endif
    }
    static void leave_fiber(Fiber& fiber)
    {
#if defined(__SANITIZE_ADDRESS__)
        __sanitizer_start_switch_fiber(fiber.finished_ ? nullptr : &fiber.fake_stack_,
                                       scheduler_stack, scheduler_stack_bytes);
#endif
        const context::transfer_t back = context::jump_fcontext(scheduler, nullptr);
        scheduler = back.fctx;
        arrive_in_fiber(fiber);
    }
    static void run(context::transfer_t from)
    {
        scheduler = from.fctx;
        Fiber& fiber = *running;
        arrive_in_fiber(fiber);
        fiber.entry_(fiber.argument_);
        fiber.finished_ = true;
        leave_fiber(fiber);
    }
};

Fiber::Fiber()
    : stack_(static_cast<std::byte*>(mmap(nullptr, kStackBytes, PROT_READ | PROT_WRITE,
                                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)))
{
    if (stack_ == MAP_FAILED) {
        throw std::bad_alloc();
    }
}

Fiber::~Fiber()
{
    unpoison(stack_, kStackBytes);
    munmap(stack_, kStackBytes);
#if defined(HSGM_THREAD_SANITIZER)
    if (sanitizer_fiber_ != nullptr) {
        __tsan_destroy_fiber(sanitizer_fiber_);
    }
#endif
}

void Fiber::prepare(void (*entry)(void*), void* argument)
{
    unpoison(stack_, kStackBytes);
    entry_ = entry;
    argument_ = argument;
    finished_ = false;
    fake_stack_ = nullptr;
    context_ = context::make_fcontext(stack_ + kStackBytes, kStackBytes, &Switch::run);
#if defined(HSGM_THREAD_SANITIZER)
    if (sanitizer_fiber_ == nullptr) {
        sanitizer_fiber_ = __tsan_create_fiber(0);
    }
#endif
}

void Fiber::resume()
{
    running = this;
#if defined(__SANITIZE_ADDRESS__)
    void* own_fake_stack = nullptr;
    __sanitizer_start_switch_fiber(&own_fake_stack, stack_, kStackBytes);
#endif
#if defined(HSGM_THREAD_SANITIZER)
    void* const own_fiber = __tsan_get_current_fiber();
    __tsan_switch_to_fiber(sanitizer_fiber_, __tsan_switch_to_fiber_no_sync);
#endif
    context_ = context::jump_fcontext(context_, nullptr).fctx;
#if defined(HSGM_THREAD_SANITIZER)
    __tsan_switch_to_fiber(own_fiber, __tsan_switch_to_fiber_no_sync);
#endif
#if defined(__SANITIZE_ADDRESS__)
    __sanitizer_finish_switch_fiber(own_fake_stack, nullptr, nullptr);
#endif
    running = nullptr;
}

void Fiber::release([[maybe_unused]] void* object)
{
#if defined(HSGM_THREAD_SANITIZER)
    void* const own_fiber = __tsan_get_current_fiber();
    __tsan_switch_to_fiber(sanitizer_fiber_, __tsan_switch_to_fiber_no_sync);
    stand_in::release(object);
    __tsan_switch_to_fiber(own_fiber, __tsan_switch_to_fiber_no_sync);
#endif
}

void Fiber::pause()
{
    Switch::leave_fiber(*running);
}

} // namespace hsgm::stand_in
