#pragma once

#include "tiling/rect.h"

#include <algorithm>
#include <vector>

namespace hsgm::pipeline {

/// Squares of `side_px`, evenly spread over an image and clipped to it, at most `across` a row
/// and column: samples of the whole.
inline std::vector<tiling::Rect> spread_patches(tiling::Size size, int side_px, int across)
{
    const auto count = [&](int extent) {
        return std::clamp((extent + side_px / 2) / side_px, 1, across);
    };
    const int down = count(size.rows);
    const int beside = count(size.cols);
    std::vector<tiling::Rect> patches;
    for (int i = 0; i < down * beside; ++i) {
        const int row = (2 * (i / beside) + 1) * size.rows / (2 * down) - side_px / 2;
        const int col = (2 * (i % beside) + 1) * size.cols / (2 * beside) - side_px / 2;
        patches.push_back(intersect({row, col, side_px, side_px}, tiling::rect_of(size)));
    }
    return patches;
}

} // namespace hsgm::pipeline
