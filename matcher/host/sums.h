#pragma once

#include "tiling/disparity_range.h"
#include "tiling/rect.h"

#include <cstddef>
#include <cstdint>

namespace hsgm::matcher::host {

/// Sums S of one pixel, `stride` of them: first those of the even indices 0, 2, 4, ..., then
/// those of the odd ones. (Two bytes side by side in a vector of path costs are the low and
/// the high half of a 16-bit lane: split like this they are summed without being shuffled.)
inline std::uint16_t sum_at(const std::uint16_t* sums, int stride, int index)
{
    return sums[(index % 2 != 0 ? stride / 2 : 0) + index / 2];
}

/// Sums S of a block's core pixels, borrowed from the workspace they were computed in.
struct BlockSums {
    tiling::Rect core;
    tiling::DisparityRange range;
    int stride = 0;
    const std::uint16_t* data = nullptr;

    const std::uint16_t* at(int row, int col) const
    {
        return data + (std::size_t(row - core.row) * std::size_t(core.cols) +
                       std::size_t(col - core.col)) *
                          std::size_t(stride);
    }
};

} // namespace hsgm::matcher::host
