#pragma once

#include "tiling/rect.h"

namespace hsgm::tiling {

/// Disparities min..max, both inclusive, in pixels of one pyramid level.
/// Disparity is x_left - x_right and may be negative.
struct DisparityRange {
    int min = 0;
    int max = -1;

    int count() const { return max - min + 1; }
    bool contains(int disparity_px) const { return disparity_px >= min && disparity_px <= max; }
    bool operator==(const DisparityRange&) const = default;
};

/// The columns of the right image that pixels of the left columns of `left` can meet:
/// x_right = x_left - d for every d of `range`. Not clipped.
inline Rect right_reach(const Rect& left, DisparityRange range)
{
    return {left.row, left.col - range.max, left.rows, left.cols + range.max - range.min};
}

} // namespace hsgm::tiling
