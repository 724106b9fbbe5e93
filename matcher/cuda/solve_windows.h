#pragma once

#include "matcher/cuda/solve_job.h"

#include <cstddef>
#include <span>

namespace hsgm::matcher::cuda {

/// A kernel for ranges up to so many disparities.
template <typename Cell>
struct WindowKernel {
    void (*kernel)(SolveJob<Cell>);
    int lanes; ///< that share a pixel
    int words; ///< pairs of disparities of a lane

    int most_count() const { return 2 * lanes * words; }
};

/// By rising width.
std::span<const WindowKernel<std::uint8_t>> window_kernels(std::uint8_t);
std::span<const WindowKernel<std::uint16_t>> window_kernels(std::uint16_t);

/// What a block of a kernel keeps where. `rows` of a strip are as many as the shared memory
/// has room for; 0 where not even the least does.
StripLayout strip_layout(int words, int lanes, int window_px, int halo_px, int paths,
                         std::size_t cell_bytes, std::size_t shared_bytes);

} // namespace hsgm::matcher::cuda
