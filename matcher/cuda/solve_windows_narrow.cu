#include "matcher/cuda/solve_windows.cuh"
#include "matcher/cuda/solve_windows.h"

#include <array>

namespace hsgm::matcher::cuda {

// Path costs of 8 bits wherever they are stored.
std::span<const WindowKernel<std::uint8_t>> window_kernels(std::uint8_t)
{
    using Cell = std::uint8_t;
    static constexpr std::array<WindowKernel<Cell>, 6> kKernels{{
        {solve_windows<Cell, LaneGroup<2, 8>>, 2, 8},
        {solve_windows<Cell, LaneGroup<4, 8>>, 4, 8},
        {solve_windows<Cell, LaneGroup<8, 8>>, 8, 8},
        {solve_windows<Cell, LaneGroup<16, 8>>, 16, 8},
        {solve_windows<Cell, LaneGroup<32, 8>>, 32, 8},
        {solve_windows<Cell, WideGroup>, kWarp, 0},
    }};
    return kKernels;
}

} // namespace hsgm::matcher::cuda
