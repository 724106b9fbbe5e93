#pragma once

#include <cstddef>

namespace hsgm::stand_in {

/// A function with a stack of its own, which can pause and go on: one CUDA thread. The
/// sanitizers are told of every switch; to the thread sanitizer each fiber is a thread, and
/// switching orders nothing, so that it sees the races a device would have.
class Fiber {
public:
    Fiber();
    ~Fiber();
    Fiber(const Fiber&) = delete;
    Fiber& operator=(const Fiber&) = delete;

    /// Readies the fiber to run `entry(argument)` from its beginning. What it was doing
    /// before is forgotten; its stack is not unwound.
    void prepare(void (*entry)(void*), void* argument);
    /// Runs it until it pauses or ends. Called from outside all fibers.
    void resume();
    /// Tells the thread sanitizer that all that the fiber has done comes before an acquire of
    /// `object`, where the fiber will not say so itself. Called from outside all fibers.
    void release(void* object);
    /// Goes back to whoever resumed the running fiber.
    static void pause();

    bool finished() const { return finished_; }

private:
    struct Switch;
    friend struct Switch;

    std::byte* stack_;
    void* context_ = nullptr;
    void (*entry_)(void*) = nullptr;
    void* argument_ = nullptr;
    bool finished_ = true;
    void* fake_stack_ = nullptr; // of the address sanitizer
    void* sanitizer_fiber_ = nullptr;
};

} // namespace hsgm::stand_in
