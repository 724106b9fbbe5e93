#include "tests/reference/paths.h"

#include "tests/reference/ensure.h"

#include <algorithm>
#include <stdexcept>

namespace hsgm::reference {

std::vector<Step> directions(int paths)
{
    const std::vector<Step> four{{0, 1}, {0, -1}, {1, 0}, {-1, 0}};
    const std::vector<Step> diagonals{{1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    const std::vector<Step> knights{{1, 2}, {1, -2}, {-1, 2}, {-1, -2},
                                    {2, 1}, {2, -1}, {-2, 1}, {-2, -1}};
    std::vector<Step> result = four;
    switch (paths) {
    case 4:
        return result;
    case 5:
        return {{0, 1}, {0, -1}, {1, 0}, {1, 1}, {1, -1}};
    case 8:
        result.insert(result.end(), diagonals.begin(), diagonals.end());
        return result;
    case 16:
        result.insert(result.end(), diagonals.begin(), diagonals.end());
        result.insert(result.end(), knights.begin(), knights.end());
        return result;
    default:
        throw std::logic_error("no such number of paths");
    }
}

std::uint32_t gradient_penalty(int p1, int p2, int half, int a)
{
    return static_cast<std::uint32_t>(p1 + (p2 - p1) * half / (half + a));
}

std::uint32_t paper_penalty(int p1, int p2, int a)
{
    return static_cast<std::uint32_t>(p1 + (p2 - p1) / (1 + a));
}

PixelCosts path_costs(const PixelCosts& matching, const PixelCosts& predecessor,
                      std::uint32_t p1, std::uint32_t p2)
{
    ensure(matching.range == predecessor.range, "eq. 1 stays within one range");
    const DisparityRange range = matching.range;
    const std::uint32_t m = predecessor.least();
    PixelCosts result(range);
    for (int d = range.min; d <= range.max; ++d) {
        std::uint32_t best = std::min(predecessor.at(d), m + p2);
        if (range.contains(d - 1)) {
            best = std::min(best, predecessor.at(d - 1) + p1);
        }
        if (range.contains(d + 1)) {
            best = std::min(best, predecessor.at(d + 1) + p1);
        }
        result.at(d) = matching.at(d) + best - m;
    }
    return result;
}

PixelCosts coarse_start(const PixelCosts& coarse, DisparityRange range, int p2, bool eight_bits)
{
    const std::uint32_t least = coarse.least();
    std::uint32_t elsewhere = static_cast<std::uint32_t>(p2) + 24;
    if (eight_bits) {
        elsewhere = std::min(elsewhere, 255u);
    }
    const auto v = [&](int D) {
        return coarse.range.contains(D) ? coarse.at(D) - least : elsewhere;
    };
    PixelCosts result(range);
    for (int d = range.min; d <= range.max; ++d) {
        const int half = tiling::floor_div(d, 2);
        result.at(d) = d % 2 == 0 ? v(half) : (v(half) + v(half + 1) + 1) >> 1;
        ensure(!eight_bits || result.at(d) <= 255, "a coarse start fits 8 bits");
    }
    return result;
}

std::vector<Window> grid_windows(Size image, int window_px)
{
    std::vector<Window> windows;
    for (int row = 0; row < image.rows; row += window_px) {
        for (int col = 0; col < image.cols; col += window_px) {
            const Rect cell{row, col, window_px, window_px};
            windows.push_back({tiling::intersect(cell, tiling::rect_of(image)), {}});
        }
    }
    return windows;
}

Rect path_region(const Rect& core, Step step, int halo_px, Size image)
{
    const int above = step.rows > 0 ? halo_px : 0;
    const int below = step.rows < 0 ? halo_px : 0;
    const int before = step.cols > 0 ? halo_px : 0;
    const int after = step.cols < 0 ? halo_px : 0;
    const Rect region = tiling::rect_between(core.row - above, core.col - before,
                                             core.row_end() + below, core.col_end() + after);
    return tiling::intersect(region, tiling::rect_of(image));
}

int median_winner(const Image<int>& winners, int row, int col)
{
    std::vector<int> nine;
    for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
            nine.push_back(clamped(winners, row + i, col + j));
        }
    }
    std::sort(nine.begin(), nine.end());
    return nine[4];
}

DisparityRange pruned_range(const Rect& core, const Image<int>& coarse_winners,
                            DisparityRange level)
{
    const Rect around = tiling::rect_between(tiling::floor_div(core.row, 2) - 1,
                                             tiling::floor_div(core.col, 2) - 1,
                                             tiling::floor_div(core.row_end() - 1, 2) + 2,
                                             tiling::floor_div(core.col_end() - 1, 2) + 2);
    const Rect footprint = tiling::intersect(around, tiling::rect_of(coarse_winners.size()));
    std::vector<int> medians;
    for (int row = footprint.row; row < footprint.row_end(); ++row) {
        for (int col = footprint.col; col < footprint.col_end(); ++col) {
            medians.push_back(median_winner(coarse_winners, row, col));
        }
    }
    std::sort(medians.begin(), medians.end());
    const std::size_t drop = medians.size() >= 5 ? 2 : 0;
    const int lowest = medians[drop];
    const int highest = medians[medians.size() - 1 - drop];

    int lo = 2 * lowest - 4;
    const int hi = 2 * highest + 1 + 4;
    const int wanted = hi - lo + 1;
    const int n = (wanted + 15) / 16 * 16;
    lo -= (n - wanted) / 2;
    if (n >= level.count()) {
        return level;
    }
    lo = std::clamp(lo, level.min, level.max - n + 1);
    return {lo, lo + n - 1};
}

} // namespace hsgm::reference
