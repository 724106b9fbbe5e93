#include "pipeline/stages/given_heights.h"

#include "pipeline/geometry/disparity_bounds.h"
#include "pipeline/geometry/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace hsgm::pipeline {

namespace {

/// Of the tie points: more outside the heights that were given deserve a word.
constexpr double kManyOutside = 0.05;

} // namespace

void warn_of_heights(const geometry::HeightSpan& given,
                     std::span<const geometry::TiePoint> points,
                     const geometry::EpipolarFrame& frame, double level_m,
                     std::vector<std::string>& warnings)
{
    // A pixel beside them is no news.
    const double low_px = (given.low_m - level_m) * frame.px_per_m - 1;
    const double high_px = (given.high_m - level_m) * frame.px_per_m + 1;
    const auto outside =
        std::count_if(points.begin(), points.end(), [&](const geometry::TiePoint& p) {
            return p.disparity_px() < low_px || p.disparity_px() > high_px;
        });
    const auto bounds = geometry::bounds_of(points);
    if (bounds &&
        static_cast<double>(outside) > kManyOutside * static_cast<double>(points.size())) {
        warnings.push_back(fmt::format(
            "geometry.heights_m is [{:g}, {:g}], but {} of {} tie points lie outside, all in "
            "all between {:.0f} and {:.0f} m: what is outside will be missing or wrong",
            given.low_m, given.high_m, outside, points.size(),
            level_m + bounds->min_px / frame.px_per_m,
            level_m + bounds->max_px / frame.px_per_m));
    }
}

std::string word_on_heights(const std::optional<geometry::HeightSpan>& given,
                            const std::function<geometry::HeightSpan()>& find)
{
    if (!given) {
        return "";
    }
    std::string found = "check them, or leave them out to have them found";
    try {
        const geometry::HeightSpan heights = find();
        found =
            fmt::format("by the images the ground lies at {:.0f} to {:.0f} m; mend them, or "
                        "leave them out",
                        heights.low_m, heights.high_m);
    } catch (const geometry::GeometryError&) {
        // Then the heights need not be the cause.
    }
    return fmt::format("; geometry.heights_m is [{:g}, {:g}]: {}", given->low_m, given->high_m,
                       found);
}

} // namespace hsgm::pipeline
