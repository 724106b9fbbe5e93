#pragma once

#include "matcher/host/disparity_plane.h"

namespace hsgm::matcher::host {

/// How far to trust the values of `wanted` (docs/algorithm.md, section 6, step 7): 1..255, 0
/// where there is none. `disparities` and `margins`, the first pass' confidence, must hold
/// `wanted` grown by kConfidenceReach and clipped to the image.
tiling::Patch<std::uint8_t> confidences(const DisparityPlane& disparities,
                                        const tiling::Patch<std::uint8_t>& margins,
                                        const tiling::Rect& wanted);

} // namespace hsgm::matcher::host
