#pragma once

#include "matcher/cuda/level_memory.h"

namespace hsgm::matcher::cuda {

/// What the workers of a device share: the coarsest level, and the tables.
template <typename Cell>
struct SharedMemory {
    bool has_coarse = false;
    LevelStore<Cell> store;
    Window* window = nullptr;
    Plane<std::uint8_t> tone; ///< for eq. 3
    std::uint16_t* p2 = nullptr;
    std::uint8_t* hmi = nullptr;
};

/// Lays it out.
template <typename Cell>
SharedMemory<Cell> lay_out_shared(Arena& arena, const Matcher& matcher);

/// It on a device.
template <typename Cell>
class CoarseOnDevice final : public DeviceCoarse {
public:
    CoarseOnDevice(const Matcher& matcher, const CoarseSolution& coarse,
                   const DeviceInfo& device);
    const SharedMemory<Cell>& memory() const { return memory_; }

private:
    DeviceBuffer buffer_;
    SharedMemory<Cell> memory_;
};

} // namespace hsgm::matcher::cuda
