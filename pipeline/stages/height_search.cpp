#include "pipeline/stages/height_search.h"

#include "pipeline/geometry/disparity_bounds.h"
#include "pipeline/stages/quick_match.h"

#include <fmt/format.h>

#include <cmath>

namespace hsgm::pipeline {

namespace {

using geometry::HeightSpan;

constexpr int kSearches = 4;
/// Wrong matches that pass the left-right check rarely have more; right ones mostly do.
constexpr int kLeastConfidence = 160;
/// Of the reach of a search: beyond a wider gap there is no ground to be followed further.
constexpr double kWidestGap = 0.15;

} // namespace

HeightSearch search_heights(HeightSpan first, int reduction,
                            const std::function<DrawnPair(double, HeightSpan)>& draw)
{
    HeightSpan search = first;
    HeightSpan heights;
    for (int i = 0; i < kSearches; ++i) {
        const double level_m = (search.low_m + search.high_m) / 2;
        const DrawnPair pair = draw(level_m, search);
        const auto reach = static_cast<int>(
            std::ceil((search.high_m - search.low_m) / 2 * pair.frame.px_per_m));
        const tiling::Image<float> map =
            quick_match(pair.left, pair.right, {-reach, reach}, kLeastConfidence);
        const auto found = geometry::bounds_of(map.view());
        if (!found) {
            return {first, "the reduced images could not be matched; the range of heights "
                           "comes from tie points alone"};
        }
        // What the reduced images are too coarse for: a tower of two of their pixels.
        const double step_m = 1 / (pair.frame.px_per_m * reduction);
        heights = {level_m + found->min_px / pair.frame.px_per_m - (4 + 2 * reduction) * step_m,
                   level_m + found->max_px / pair.frame.px_per_m +
                       (4 + 3 * reduction) * step_m};
        const bool ends_low = found->min_px < -reach + 2;
        const bool ends_high = found->max_px > reach - 2;
        if (!ends_low && !ends_high) {
            return {heights, ""};
        }
        const bool strays = (ends_low && found->low_gap_px > kWidestGap * reach) ||
                            (ends_high && found->high_gap_px > kWidestGap * reach);
        if (strays) {
            return {
                heights,
                fmt::format("the reduced images match at heights far from those of the "
                            "ground, which is what clouds and repeated patterns do; looking "
                            "for ground at {:.0f} to {:.0f} m; geometry.heights_m can say "
                            "better",
                            heights.low_m, heights.high_m)};
        }
        const double more_m = search.high_m - search.low_m;
        search.low_m -= ends_low ? more_m : 0;
        search.high_m += ends_high ? more_m : 0;
    }
    return {heights, fmt::format("the range of heights is very wide, {:.0f} to {:.0f} m: "
                                 "clouds, or heights should be given",
                                 heights.low_m, heights.high_m)};
}

} // namespace hsgm::pipeline
