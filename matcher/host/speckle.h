#pragma once

#include "matcher/host/disparity_plane.h"

namespace hsgm::matcher::host {

/// Takes away the values of connected segments of fewer than `least_px` pixels
/// (docs/algorithm.md, section 6, step 5): neighbours in rows and columns belong together
/// where they differ by `range_q8` at most. Exact for the pixels of `decided`, if the plane
/// reaches `least_px - 1` pixels beyond them or to the image's border: a segment that leaves
/// the plane has a path of `least_px` pixels inside it. Elsewhere values stay.
void remove_speckles(int least_px, int range_q8, const tiling::Rect& decided,
                     DisparityPlane& plane, tiling::Patch<std::uint16_t>& reasons);

/// Upper bound of the memory that it takes for a plane of this size.
std::int64_t speckle_bytes(tiling::Size size);

} // namespace hsgm::matcher::host
