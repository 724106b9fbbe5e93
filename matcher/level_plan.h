#pragma once

#include "matcher/options.h"
#include "tiling/disparity_range.h"
#include "tiling/rect.h"
#include "tiling/support.h"

#include <vector>

namespace hsgm::matcher {

/// The geometry of a rectified pair: equal heights, widths as they are, and the
/// disparities asked for (x_left - x_right, both ends inclusive).
struct PairShape {
    tiling::Size left;
    tiling::Size right;
    tiling::DisparityRange asked;
};

/// Sizes and disparity ranges of every pyramid level, level 0 first. A pure function of the
/// pair and the options: it never looks at memory or tiles, since it defines the result.
struct LevelPlan {
    std::vector<tiling::Size> left_sizes;
    std::vector<tiling::Size> right_sizes;
    std::vector<tiling::DisparityRange> ranges;
    bool coarsest_whole = true; ///< false in mode `local`: its one level goes by windows

    int levels() const { return static_cast<int>(ranges.size()); }
    /// Levels that are matched by windows: all, or all but the coarsest.
    int windowed_levels() const { return levels() - (coarsest_whole ? 1 : 0); }
};

/// The plan of a match (docs/algorithm.md, section 2). Throws std::invalid_argument if the
/// shape is empty, heights differ, the range is reversed, or no left pixel has a
/// counterpart for any disparity of the range.
LevelPlan plan_levels(const PairShape& shape, const Options& options);

/// How far results of these (resolved) options reach; input of tiling::tile_support.
tiling::SupportRule support_rule(const Options& options);

} // namespace hsgm::matcher
