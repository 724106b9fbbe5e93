#include "matcher/level_plan.h"

#include "tiling/pyramid.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace hsgm::matcher {

namespace {

constexpr int kLeastLevels = 3;
constexpr int kMostLevels = 12;
constexpr int kFurthestDisparity = 16000; // winners are kept in 16 bits
constexpr int kLeastSide_px = 32;
constexpr std::int64_t kMostCoarseCells = std::int64_t{1} << 25;

std::string text(tiling::Size size)
{
    return std::to_string(size.cols) + " x " + std::to_string(size.rows) + " px";
}

void check(const PairShape& shape)
{
    if (shape.left.area() <= 0 || shape.right.area() <= 0) {
        throw std::invalid_argument("both images need at least 1 x 1 px");
    }
    if (shape.left.rows != shape.right.rows) {
        throw std::invalid_argument("a rectified pair has equal heights, but left is " +
                                    text(shape.left) + " and right " + text(shape.right));
    }
    const auto asked = shape.asked;
    const std::string range = std::to_string(asked.min) + ".." + std::to_string(asked.max);
    if (asked.count() < 1) {
        throw std::invalid_argument("the disparity range " + range +
                                    " is reversed: give the smaller number first");
    }
    if (asked.min < -kFurthestDisparity || asked.max > kFurthestDisparity) {
        throw std::invalid_argument("the disparity range " + range + " must lie within " +
                                    std::to_string(-kFurthestDisparity) + ".." +
                                    std::to_string(kFurthestDisparity));
    }
    if (asked.min > shape.left.cols - 1 || asked.max < -(shape.right.cols - 1)) {
        throw std::invalid_argument(
            "with disparities " + range + " no left pixel has a counterpart: images of " +
            std::to_string(shape.left.cols) + " and " + std::to_string(shape.right.cols) +
            " columns allow " + std::to_string(-(shape.right.cols - 1)) + ".." +
            std::to_string(shape.left.cols - 1));
    }
}

int least_side_px(const PairShape& shape, int level)
{
    const int side = std::min({shape.left.rows, shape.left.cols, shape.right.cols});
    return tiling::ceil_div(side, 1 << level);
}

std::int64_t coarsest_cells(const PairShape& shape, int levels)
{
    const auto size = tiling::pyramid_sizes(shape.left, levels).back();
    return size.area() * tiling::pyramid_ranges(shape.asked, levels).back().count();
}

int level_count(const PairShape& shape, const Options& options)
{
    if (options.levels > 0) {
        return options.levels;
    }
    int levels = kLeastLevels;
    if (options.mode == Mode::hsgm) {
        while (levels < kMostLevels && coarsest_cells(shape, levels) > kMostCoarseCells) {
            ++levels;
        }
    }
    while (levels > 1 && least_side_px(shape, levels - 1) < kLeastSide_px) {
        --levels;
    }
    return levels;
}

} // namespace

LevelPlan plan_levels(const PairShape& shape, const Options& options)
{
    check(shape);
    const int levels = level_count(shape, options.resolved());
    LevelPlan plan;
    plan.left_sizes = tiling::pyramid_sizes(shape.left, levels);
    plan.right_sizes = tiling::pyramid_sizes(shape.right, levels);
    plan.ranges = tiling::pyramid_ranges(shape.asked, levels);
    plan.coarsest_whole = options.mode != Mode::local;
    return plan;
}

tiling::SupportRule support_rule(const Options& options)
{
    constexpr int kGateRadius = 3;
    const CostTraits cost = traits(options.cost);
    tiling::SupportRule rule;
    rule.window_px = options.window_px;
    rule.halo_px = options.halo_px;
    rule.path_step_px = options.paths == 16 ? 2 : 1;
    rule.range_look_px = options.prune ? 2 : 0;
    rule.image_radius_rows = std::max(kGateRadius, cost.radius_rows);
    rule.image_radius_cols = std::max(kGateRadius, cost.radius_cols);
    rule.coarsest_whole = options.mode != Mode::local;
    return rule;
}

} // namespace hsgm::matcher
