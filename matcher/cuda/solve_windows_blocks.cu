#include "matcher/cuda/solve_windows.cuh"
#include "matcher/cuda/solve_windows.h"

#include <array>

namespace hsgm::matcher::cuda {

// Costs over blocks are rare: few kernels do for them.
std::span<const WindowKernel<std::uint8_t>> block_kernels(std::uint8_t)
{
    using Cell = std::uint8_t;
    static constexpr std::array<WindowKernel<Cell>, 3> kKernels{{
        {solve_windows<Cell, LaneGroup<8, 8>, true>, 8, 8},
        {solve_windows<Cell, LaneGroup<32, 8>, true>, 32, 8},
        {solve_windows<Cell, WideGroup, true>, kWarp, 0},
    }};
    return kKernels;
}

std::span<const WindowKernel<std::uint16_t>> block_kernels(std::uint16_t)
{
    using Cell = std::uint16_t;
    static constexpr std::array<WindowKernel<Cell>, 2> kKernels{{
        {solve_windows<Cell, LaneGroup<32, 8>, true>, 32, 8},
        {solve_windows<Cell, WideGroup, true>, kWarp, 0},
    }};
    return kKernels;
}

} // namespace hsgm::matcher::cuda
