#include "tiling/support.h"

#include <cstddef>

namespace hsgm::tiling {

namespace {

Rect expand_rows_cols(const Rect& r, int rows, int cols)
{
    return {r.row - rows, r.col - cols, r.rows + 2 * rows, r.cols + 2 * cols};
}

LevelSupport support_of_windows(const Rect& windows, Size left, Size right,
                                DisparityRange range, const SupportRule& rule)
{
    LevelSupport s;
    s.windows = intersect(windows, rect_of(left));
    s.aggregation = intersect(expand(windows, rule.halo_px), rect_of(left));
    const Rect read =
        expand_rows_cols(s.aggregation, rule.image_radius_rows, rule.image_radius_cols);
    s.left_image = intersect(read, rect_of(left));
    s.right_image = intersect(right_reach(read, range), rect_of(right));
    return s;
}

// What the windows of one level read from the results of the next coarser one: the costs
// from which paths start just outside the halo, the prior under every pixel, and the
// disparities round each window's footprint.
Rect read_from_coarser(const LevelSupport& fine, Size fine_size, const SupportRule& rule)
{
    const Rect path_starts =
        intersect(expand(fine.aggregation, rule.path_step_px), rect_of(fine_size));
    const Rect ranges =
        rule.range_look_px == 0 ? Rect{} : expand(halve(fine.windows), rule.range_look_px);
    return unite(halve(path_starts), ranges);
}

} // namespace

std::vector<LevelSupport> tile_support(const Rect& core, std::span<const Size> left_sizes,
                                       std::span<const Size> right_sizes,
                                       std::span<const DisparityRange> ranges,
                                       const SupportRule& rule)
{
    const std::size_t levels = left_sizes.size();
    const std::size_t windowed = rule.coarsest_whole ? levels - 1 : levels;
    std::vector<LevelSupport> support;
    Rect needed = core;
    for (std::size_t level = 0; level < windowed; ++level) {
        support.push_back(support_of_windows(round_out(needed, rule.window_px),
                                             left_sizes[level], right_sizes[level],
                                             ranges[level], rule));
        if (level + 1 < levels) {
            needed = intersect(read_from_coarser(support.back(), left_sizes[level], rule),
                               rect_of(left_sizes[level + 1]));
        }
    }
    if (rule.coarsest_whole) {
        LevelSupport coarsest;
        coarsest.windows = needed;
        coarsest.aggregation = needed;
        support.push_back(coarsest);
    }
    return support;
}

} // namespace hsgm::tiling
