#pragma once

#include "tiling/disparity_range.h"
#include "tiling/rect.h"

#include <span>
#include <vector>

namespace hsgm::tiling {

/// How far a matched pixel looks, in pixels of its own level unless said otherwise.
/// These numbers belong to the matcher's options; tile sizes do not appear.
struct SupportRule {
    int window_px = 64;        ///< side of an aggregation window, on the global grid
    int halo_px = 8;           ///< pixels a path runs before it enters its window
    int path_step_px = 1;      ///< longest step of a path: 1, or 2 with sixteen paths
    int range_look_px = 2;     ///< pixels of the coarser level read beyond a window's footprint
                               ///< to find its disparity range; 0 without pruning
    int image_radius_rows = 3; ///< rows of the image that a cost or gate reads around a pixel
    int image_radius_cols = 3; ///< the same for columns
    bool coarsest_whole = true; ///< the coarsest level is solved as one piece, not by windows
};

/// Everything of one pyramid level that a tile's result depends on, in that level's global
/// pixels, clipped to the level's images.
struct LevelSupport {
    Rect windows;     ///< whole windows whose results are needed
    Rect aggregation; ///< those windows with their halo: where costs are computed
    Rect left_image;  ///< pixels read from the left image
    Rect right_image; ///< pixels read from the right image
};

/// The support of the pixels `core` of level 0, for levels 0, 1, ... in this order.
/// Where the coarsest level is solved whole, its `windows` say which of its results are
/// read, and its image rectangles are empty: no tile needs them.
/// All spans hold one entry a level.
std::vector<LevelSupport> tile_support(const Rect& core, std::span<const Size> left_sizes,
                                       std::span<const Size> right_sizes,
                                       std::span<const DisparityRange> ranges,
                                       const SupportRule& rule);

} // namespace hsgm::tiling
