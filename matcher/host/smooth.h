#pragma once

#include "matcher/host/disparity_plane.h"

namespace hsgm::matcher::host {

/// Means over the side x side squares (odd, at most 5) round the pixels of `wanted` that have a
/// value, of those values in the square that lie within one pixel of the centre's, rounded to
/// the nearest (docs/algorithm.md, section 6). Holes stay kHole. `disparities` must hold
/// `wanted` grown by side / 2 and clipped to the image.
tiling::Patch<std::int32_t> smoothed(const tiling::Patch<std::int32_t>& disparities, int side,
                                     const tiling::Rect& wanted);

/// Working memory of `smoothed` for input of that size.
std::int64_t smooth_bytes(tiling::Size size);

} // namespace hsgm::matcher::host
