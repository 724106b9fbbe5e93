#pragma once

#include "matcher/host/level_result.h"
#include "matcher/kernel.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace hsgm::matcher::host {

/// Spreads one coarse value per disparity over the finer disparities `fine`: even ones take
/// their coarse value, odd ones the rounded mean of their two neighbours; coarse
/// disparities outside `coarse` count as `fill`.
/// `out[i]` is the value of fine.min + i. `scratch` needs fine.count() + 6 elements, `out`
/// fine.count() + 3.
template <typename T>
void spread_disparities(const T* values, tiling::DisparityRange coarse,
                        tiling::DisparityRange fine, T fill, T* scratch, T* out)
{
    const int first = tiling::floor_div(fine.min, 2);
    const int count = tiling::floor_div(fine.max, 2) - first + 1;
    // scratch[j] = value of coarse disparity first + j, for j = 0..count
    std::fill(scratch, scratch + count + 1, fill);
    const int begin = std::max(first, coarse.min);
    const int end = std::min(first + count, coarse.max);
    if (begin <= end) {
        std::copy(values + (begin - coarse.min), values + (end - coarse.min) + 1,
                  scratch + (begin - first));
    }
    const int odd_start = fine.min - 2 * first;
    if (odd_start != 0) {
        out[0] = static_cast<T>(between(scratch[0], scratch[1]));
    }
    T* even = out + odd_start;
    const T* v = scratch + odd_start;
    const int pairs = (fine.count() - odd_start + 1) / 2;
    for (int j = 0; j < pairs; ++j, even += 2) {
        even[0] = v[j];
        even[1] = static_cast<T>(between(v[j], v[j + 1]));
    }
}

/// Where paths start that enter a window: the coarser level's costs, spread (eq. 2).
template <typename L>
struct CoarseStart {
    const LevelResult<L>* coarser = nullptr;
    int unsearched = 0; ///< value of a coarse disparity outside its block's range

    /// Costs of the pixel (row, col) of the finer level, for direction number `direction`.
    /// `scratch` and `out` as for spread_disparities.
    void costs(int row, int col, std::size_t direction, tiling::DisparityRange fine, L* scratch,
               L* out) const
    {
        const auto& block = coarser->block_at(row / 2, col / 2);
        const L* kept = block.lines[direction].at(row / 2, col / 2);
        spread_disparities(kept, block.range, fine, static_cast<L>(unsearched), scratch, out);
    }
};

} // namespace hsgm::matcher::host
