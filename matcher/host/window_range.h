#pragma once

#include "tiling/disparity_range.h"
#include "tiling/image.h"

#include <cstdint>

namespace hsgm::matcher::host {

/// Median of the 3 x 3 winners round every pixel, replicated at the borders of the level
/// (`size`), for the pixels whose whole neighbourhood lies in `winners`.
tiling::Patch<std::int16_t> winner_medians(const tiling::Patch<std::int16_t>& winners,
                                           tiling::Size size);

/// The disparities worth searching in the window `core`: those of the coarser level, of
/// size `coarse_size`, under and round it, without the two most extreme on either side
/// (docs/algorithm.md, section 4); widened to a multiple of 16 inside `level`.
tiling::DisparityRange window_range(const tiling::Patch<std::int16_t>& coarse_medians,
                                    tiling::Size coarse_size, const tiling::Rect& core,
                                    tiling::DisparityRange level);

} // namespace hsgm::matcher::host
