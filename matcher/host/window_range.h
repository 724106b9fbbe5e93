#pragma once

#include "matcher/host/level_result.h"
#include "matcher/median.h"

#include <algorithm>
#include <array>
#include <vector>

namespace hsgm::matcher::host {

/// Median of the 3 x 3 coarse winners round a pixel, replicated at the level's borders.
template <typename L>
int median_winner(const LevelResult<L>& coarse, int row, int col)
{
    std::array<int, 9> values{};
    std::size_t n = 0;
    for (int dr = -1; dr <= 1; ++dr) {
        const int r = std::clamp(row + dr, 0, coarse.size.rows - 1);
        for (int dc = -1; dc <= 1; ++dc) {
            values[n++] = coarse.winner(r, std::clamp(col + dc, 0, coarse.size.cols - 1));
        }
    }
    return median_of_nine(values);
}

/// The range of `level` widened to a multiple of 16 and shifted to lie inside `level`.
inline tiling::DisparityRange rounded_range(tiling::DisparityRange needed,
                                            tiling::DisparityRange level)
{
    const int count = (needed.count() + 15) / 16 * 16;
    if (count >= level.count()) {
        return level;
    }
    const int low =
        std::clamp(needed.min - (count - needed.count()) / 2, level.min, level.max - count + 1);
    return {low, low + count - 1};
}

/// The disparities worth searching in the window `core`: those of the coarser level under
/// and round it, without the two most extreme on either side (docs/algorithm.md, section 4).
template <typename L>
tiling::DisparityRange window_range(const LevelResult<L>& coarse, const tiling::Rect& core,
                                    tiling::DisparityRange level)
{
    constexpr int kFootprintMargin = 1;
    constexpr int kDropped = 2;
    constexpr int kMargin = 4;
    const tiling::Rect footprint =
        intersect(expand(halve(core), kFootprintMargin), rect_of(coarse.size));
    std::vector<int> medians;
    medians.reserve(static_cast<std::size_t>(footprint.area()));
    for (int row = footprint.row; row < footprint.row_end(); ++row) {
        for (int col = footprint.col; col < footprint.col_end(); ++col) {
            medians.push_back(median_winner(coarse, row, col));
        }
    }
    std::sort(medians.begin(), medians.end());
    const std::size_t dropped = medians.size() >= 2 * kDropped + 1 ? kDropped : 0;
    const int lowest = medians[dropped];
    const int highest = medians[medians.size() - 1 - dropped];
    return rounded_range({2 * lowest - kMargin, 2 * highest + 1 + kMargin}, level);
}

} // namespace hsgm::matcher::host
