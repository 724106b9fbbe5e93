#pragma once

#include "matcher/host/aligned.h"
#include "tiling/disparity_range.h"

#include <cstdint>

namespace hsgm::matcher::host {

/// Pixels side by side in a row whose coarse pixels lie in one block of the coarser level.
struct PriorRun {
    int col = 0; ///< of the first
    int cols = 0;
    const std::uint8_t* low_texture = nullptr; ///< of each: not 0 where there is little
    tiling::DisparityRange fine;               ///< of their costs
    tiling::DisparityRange coarse;             ///< of `values`
    const std::uint8_t* values = nullptr;      ///< q of the coarse pixel of the first
    int pitch = 0;                             ///< from one coarse pixel's q to the next one's
    const std::uint8_t* end = nullptr;         ///< of the bytes that may be read after `values`
};

/// Adds prior(p, d) >> 2, or >> 4 where there is texture, to the costs of the pixels
/// (docs/algorithm.md, section 3), of `stride` bytes each. Padding, 255, stays as it is. Vector
/// code, chosen for the processor at run time.
void add_prior(const PriorRun& run, std::uint8_t* costs, int stride,
               Buffer<std::uint8_t>& room);

} // namespace hsgm::matcher::host
