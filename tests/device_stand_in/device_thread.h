#pragma once

#include "tests/device_stand_in/fiber.h"
#include "tests/device_stand_in/kernel_run.h"

#include <array>
#include <memory>
#include <vector>

namespace hsgm::stand_in {

constexpr int kLanes = 32;

struct DeviceThread;

/// Lanes of a block that execute collectives together.
struct Warp {
    std::array<DeviceThread*, kLanes> lanes{}; ///< null: not there, or left the kernel
    /// Two, used in turn: a lane that is one meeting ahead must not hand its later writes to
    /// lanes that are still leaving this one. (For the thread sanitizer.)
    std::array<char, 2> meeting{};
};

enum class Waiting { nothing, lanes, threads };

struct Forbidden {
    std::byte* begin;
    std::size_t bytes;
};

struct Block {
    Index3 index;
    std::vector<std::unique_ptr<DeviceThread>> threads;
    std::vector<Warp> warps;
    std::vector<std::byte> shared;
    std::vector<Forbidden> forbidden;
    std::size_t waiting = 0; ///< threads at the barrier
    std::size_t finished = 0;
    std::array<char, 2> meeting{};
};

/// A CUDA thread, and what it waits for.
struct DeviceThread {
    Fiber fiber;
    Index3 index;
    int lane = 0;
    Block* block = nullptr;
    Warp* warp = nullptr;
    Waiting waiting = Waiting::nothing;
    Collective collective{};
    Barrier barrier{};
    Here here;
    unsigned mask = 0;
    std::uint64_t value = 0;
    int source_lane = 0;
    std::uint64_t result = 0;
    unsigned barriers = 0; ///< passed so far
    unsigned warp_meetings = 0;
};

} // namespace hsgm::stand_in
