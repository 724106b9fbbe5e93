#include "pipeline/geometry/overlap.h"

#include "pipeline/geometry/error.h"
#include "pipeline/geometry/footprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hsgm::geometry {

namespace {

constexpr int kHeights = 65;
constexpr double kMost = 0.95; // of the largest area counts as the largest
constexpr double kLeast = 0.1; // and less than that as next to nothing
constexpr double kLowestM = -500;
constexpr double kHighestM = 9000;

/// Nothing where an image does not reach the ground at that height.
Polygon outline(const GroundCamera& camera, tiling::Size size, double height_m)
{
    try {
        return footprint(camera, size, ReferenceSurface(height_m)).corners;
    } catch (const GeometryError&) {
        return {};
    }
}

std::string place_text(const Polygon& outline)
{
    if (outline.empty()) {
        return "no ground at all";
    }
    double x = 0;
    double y = 0;
    for (const MapPoint& corner : outline) {
        x += corner.x / static_cast<double>(outline.size());
        y += corner.y / static_cast<double>(outline.size());
    }
    return fmt::format("{:.1f} km2 round x {:.0f} m, y {:.0f} m", area_m2(outline) / 1e6, x, y);
}

} // namespace

Overlap find_overlap(const GroundCamera& left, tiling::Size left_size,
                     const GroundCamera& right, tiling::Size right_size, HeightSpan heights)
{
    std::vector<double> areas(kHeights);
    const auto height_of = [&](int i) {
        return heights.low_m + (heights.high_m - heights.low_m) * i / (kHeights - 1);
    };
    Overlap overlap;
    for (int i = 0; i < kHeights; ++i) {
        const Polygon a = outline(left, left_size, height_of(i));
        const Polygon b = outline(right, right_size, height_of(i));
        areas[std::size_t(i)] = a.empty() || b.empty() ? 0 : area_m2(intersection(a, b));
        overlap.area_m2 = std::max(overlap.area_m2, areas[std::size_t(i)]);
    }
    if (!(overlap.area_m2 > 0)) {
        const double middle = (heights.low_m + heights.high_m) / 2;
        throw GeometryError(fmt::format(
            "the images do not overlap: at {:.0f} m the left one shows {}, the right one {}",
            middle, place_text(outline(left, left_size, middle)),
            place_text(outline(right, right_size, middle))));
    }
    const auto range_above = [&](double share) {
        HeightSpan span{heights.high_m, heights.low_m};
        for (int i = 0; i < kHeights; ++i) {
            if (areas[std::size_t(i)] >= share * overlap.area_m2) {
                span.low_m = std::min(span.low_m, height_of(i));
                span.high_m = std::max(span.high_m, height_of(i));
            }
        }
        return span;
    };
    const HeightSpan best = range_above(kMost);
    overlap.level_m = (best.low_m + best.high_m) / 2;
    overlap.shared = range_above(kLeast);
    return overlap;
}

HeightSpan heights_of(const RpcModel& left, const RpcModel& right)
{
    HeightSpan span{kLowestM, kHighestM};
    for (const RpcModel* model : {&left, &right}) {
        const double reach = std::abs(model->height_scale_m);
        span.low_m = std::max(span.low_m, model->height_off_m - reach);
        span.high_m = std::min(span.high_m, model->height_off_m + reach);
    }
    if (!(span.low_m < span.high_m)) {
        throw GeometryError(fmt::format("the RPCs are for different heights, {:.0f} +- {:.0f} "
                                        "m and {:.0f} +- {:.0f} m: they "
                                        "are not of one place, unless the heights are given",
                                        left.height_off_m, left.height_scale_m,
                                        right.height_off_m, right.height_scale_m));
    }
    return span;
}

} // namespace hsgm::geometry
