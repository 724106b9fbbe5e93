// The kernels of a mutant: enough for few disparities, and the one for any number.

#include "matcher/cuda/solve_windows.cuh"
#include "matcher/cuda/solve_windows.h"

#include <array>

namespace hsgm::matcher::cuda {

std::span<const WindowKernel<std::uint8_t>> window_kernels(std::uint8_t)
{
    using Cell = std::uint8_t;
    static constexpr std::array<WindowKernel<Cell>, 2> kKernels{{
        {solve_windows<Cell, LaneGroup<4, 4>>, 4, 4},
        {solve_windows<Cell, WideGroup>, kWarp, 0},
    }};
    return kKernels;
}

std::span<const WindowKernel<std::uint16_t>> window_kernels(std::uint16_t)
{
    return {};
}
std::span<const WindowKernel<std::uint8_t>> block_kernels(std::uint8_t)
{
    return {};
}
std::span<const WindowKernel<std::uint16_t>> block_kernels(std::uint16_t)
{
    return {};
}

} // namespace hsgm::matcher::cuda
