#pragma once

#include "matcher/host/disparity_plane.h"

namespace hsgm::matcher::host {

/// Medians of the values in the side x side squares (3 or 5) round the pixels of `wanted` that
/// have one; the lower of two middles. Holes stay kHole. The plane must hold `wanted` grown by
/// side / 2 and clipped to the image.
tiling::Patch<std::int32_t> medians(const DisparityPlane& disparities, int side,
                                    const tiling::Rect& wanted);

} // namespace hsgm::matcher::host
