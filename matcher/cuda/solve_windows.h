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
    int words; ///< pairs of disparities of a lane; 0: any number, in device memory

    bool is_wide() const { return words == 0; }
    /// Disparities that it can do, of a level with so many.
    int most_count(int level_count) const
    {
        return is_wide() ? level_count : 2 * lanes * words;
    }
};

/// By rising width.
std::span<const WindowKernel<std::uint8_t>> window_kernels(std::uint8_t);
std::span<const WindowKernel<std::uint16_t>> window_kernels(std::uint16_t);
/// The same for costs of CostKind::block.
std::span<const WindowKernel<std::uint8_t>> block_kernels(std::uint8_t);
std::span<const WindowKernel<std::uint16_t>> block_kernels(std::uint16_t);

/// What decides where a block keeps what.
struct StripCase {
    int words; ///< of a pixel
    int lanes; ///< that share it
    bool wide = false;
    int window_px;
    int halo_px;
    int paths;
    std::size_t cell_bytes;
    std::size_t shared_bytes; ///< that a block may have
    int warps;                ///< of a block
};

/// What a block of a kernel keeps where. `rows` of a strip are as many as the shared memory
/// has room for; 0 where not even the least does.
StripLayout strip_layout(const StripCase& c);

} // namespace hsgm::matcher::cuda
