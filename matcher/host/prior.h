#pragma once

#include "matcher/host/aligned.h"
#include "tiling/disparity_range.h"

#include <cstdint>

namespace hsgm::matcher::host {

/// The prior of one coarse pixel (docs/algorithm.md, section 3).
struct PriorPixel {
    const std::uint8_t* values = nullptr; ///< q, for each disparity of `coarse`
    tiling::DisparityRange coarse;
    tiling::DisparityRange fine; ///< of the pixels to which it is added
};

/// Adds prior(p, d) >> 2 to the costs of the pixels `costs` points to, of `stride` bytes each
/// and null where none is to be added. Padding, 255, stays as it is. Vector code, chosen for
/// the processor at run time.
void add_prior(const PriorPixel& prior, int stride, std::uint8_t* const (&costs)[2],
               Buffer<std::uint8_t>& room);

} // namespace hsgm::matcher::host
