#pragma once

#include "matcher/host/disparity_plane.h"
#include "matcher/level_plan.h"

namespace hsgm::matcher::host {

/// First-pass disparities of the pixels that have a value, with the left-right check's reasons
/// for those of `explained` that lose theirs (docs/algorithm.md, section 6, step 4); elsewhere
/// the reasons stay. `tolerance_px` below 0: no check. `disparity_q8` and `reasons` hold at
/// least the pixels of `plane`, `right_keys` all that these may meet.
void check_left_right(const tiling::Patch<std::int32_t>& disparity_q8,
                      const tiling::Patch<std::uint32_t>& right_keys, const PairShape& shape,
                      int tolerance_px, const tiling::Rect& explained,
                      tiling::Patch<std::uint16_t>& reasons, DisparityPlane& plane);

} // namespace hsgm::matcher::host
