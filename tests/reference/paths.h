#pragma once

#include "tests/reference/cost.h"

#include <cstdint>
#include <vector>

namespace hsgm::reference {

/// A direction r: the predecessor of pixel p is p - r.
struct Step {
    int rows;
    int cols;
};
std::vector<Step> directions(int paths);

/// P2' of the gradient rule with its parameter `half`, `a` being the difference of the tones.
std::uint32_t gradient_penalty(int p1, int p2, int half, int a);
/// P2' of eq. 3 of Won and Jung.
std::uint32_t paper_penalty(int p1, int p2, int a);

/// Eq. 1: L(p, .) from C(p, .) and L(p - r, .), both over the same range.
PixelCosts path_costs(const PixelCosts& matching, const PixelCosts& predecessor,
                      std::uint32_t p1, std::uint32_t p2);

/// Eq. 2: what stands for L(p - r, .) over `range` where a path enters its region;
/// `coarse` is L of the same direction at the coarser pixel that holds p - r.
PixelCosts coarse_start(const PixelCosts& coarse, DisparityRange range, int p2,
                        bool eight_bits);

/// A cell of a level's grid, clipped to the image: its core, and the disparities it stores.
struct Window {
    Rect core;
    DisparityRange range;
};

/// The cells of the grid, row by row; ranges are left to the caller.
std::vector<Window> grid_windows(Size image, int window_px);
/// The pixels that paths of direction `step` run over to give the results of `core`.
Rect path_region(const Rect& core, Step step, int halo_px, Size image);

/// The median of the 3 x 3 winners round (row, col), coordinates clamped.
int median_winner(const Image<int>& winners, int row, int col);
/// The pruned range of the window `core`, from the winners of the coarser level;
/// `level` is what the level allows.
DisparityRange pruned_range(const Rect& core, const Image<int>& coarse_winners,
                            DisparityRange level);

} // namespace hsgm::reference
