#pragma once

#include "matcher/host/disparity_plane.h"

namespace hsgm::matcher::host {

/// Closes holes of `wanted` with values up to `reach_px` away (docs/algorithm.md, section 6,
/// step 10): occluded ones from the background, mismatches too where `mismatches` says so.
/// `disparity_q8` must hold `wanted` grown by `reach_px` and clipped to the image, kHole where
/// there is no value; `reasons` at least `wanted`. What was closed changes its reasons.
tiling::Patch<std::int32_t> filled(const tiling::Patch<std::int32_t>& disparity_q8,
                                   int reach_px, bool mismatches, const tiling::Rect& wanted,
                                   tiling::Patch<std::uint16_t>& reasons);

} // namespace hsgm::matcher::host
