#include "matcher/cuda/solve_windows.cuh"
#include "matcher/cuda/solve_windows.h"

#include <array>

namespace hsgm::matcher::cuda {

// Path costs of 16 bits, for penalties that take more than 8.
std::span<const WindowKernel<std::uint16_t>> window_kernels(std::uint16_t)
{
    using Cell = std::uint16_t;
    static constexpr std::array<WindowKernel<Cell>, 3> kKernels{{
        {solve_windows<Cell, LaneGroup<8, 8>>, 8, 8},
        {solve_windows<Cell, LaneGroup<32, 8>>, 32, 8},
        {solve_windows<Cell, WideGroup>, kWarp, 0},
    }};
    return kKernels;
}

} // namespace hsgm::matcher::cuda
