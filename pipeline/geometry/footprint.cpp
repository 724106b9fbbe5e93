#include "pipeline/geometry/footprint.h"

#include "pipeline/geometry/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace hsgm::geometry {

namespace {

constexpr int kMaxSteps = 50;
constexpr double kHeightTolerance = 1e-5; // m

/// Positive where c lies to the left of the line from a to b.
double side(const MapPoint& a, const MapPoint& b, const MapPoint& c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

MapPoint crossing(const MapPoint& from, const MapPoint& to, double side_from, double side_to)
{
    const double t = side_from / (side_from - side_to);
    return {from.x + t * (to.x - from.x), from.y + t * (to.y - from.y), 0};
}

Polygon cut(const Polygon& polygon, const MapPoint& a, const MapPoint& b)
{
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const MapPoint& here = polygon[i];
        const MapPoint& next = polygon[(i + 1) % polygon.size()];
        const double side_here = side(a, b, here);
        const double side_next = side(a, b, next);
        if (side_here >= 0) {
            kept.push_back(here);
        }
        if ((side_here > 0 && side_next < 0) || (side_here < 0 && side_next > 0)) {
            kept.push_back(crossing(here, next, side_here, side_next));
        }
    }
    return kept;
}

double signed_area(const Polygon& polygon)
{
    double twice = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        twice += side(polygon[0], polygon[i], polygon[i + 1]);
    }
    return twice / 2;
}

MapPoint meet_or_throw(const GroundCamera& camera, ImagePoint point,
                       const ReferenceSurface& surface, double above_m)
{
    const auto place = meet_surface(camera, point, surface, above_m);
    if (!place) {
        throw GeometryError("pixel (" + std::to_string(std::lround(point.x)) + ", " +
                            std::to_string(std::lround(point.y)) + ") meets no ground at " +
                            std::to_string(std::lround(surface.level_m() + above_m)) +
                            " m: the RPC is that of another image, or the height is wrong");
    }
    return *place;
}

} // namespace

Polygon intersection(const Polygon& a, const Polygon& b)
{
    Polygon kept = a;
    for (std::size_t i = 0; i < b.size() && !kept.empty(); ++i) {
        kept = cut(kept, b[i], b[(i + 1) % b.size()]);
    }
    return b.size() < 3 || kept.size() < 3 ? Polygon{} : kept;
}

double area_m2(const Polygon& polygon)
{
    return std::abs(signed_area(polygon));
}

std::optional<MapPoint> meet_surface(const GroundCamera& camera, ImagePoint image,
                                     const ReferenceSurface& surface, double above_m)
{
    auto place = camera.locate(image, surface.level_m() + above_m);
    for (int step = 0; place && !surface.is_level(); ++step) {
        const double height = surface.height_m(place->x, place->y) + above_m;
        if (std::abs(height - place->height_m) < kHeightTolerance) {
            break;
        }
        place = step < kMaxSteps ? camera.locate(image, height) : std::nullopt;
    }
    if (!place || !std::isfinite(place->x) || !std::isfinite(place->y)) {
        return std::nullopt;
    }
    return place;
}

Footprint footprint(const GroundCamera& camera, tiling::Size image,
                    const ReferenceSurface& surface, double above_m)
{
    const double right = image.cols - 1;
    const double bottom = image.rows - 1;
    const std::array<ImagePoint, 5> corners{
        {{0, 0}, {right, 0}, {right, bottom}, {0, bottom}, {0, 0}}};
    Polygon middles;
    Footprint result;
    for (std::size_t k = 0; k < 4; ++k) {
        result.corners.push_back(meet_or_throw(camera, corners[k], surface, above_m));
        const ImagePoint middle{(corners[k].x + corners[k + 1].x) / 2,
                                (corners[k].y + corners[k + 1].y) / 2};
        middles.push_back(meet_or_throw(camera, middle, surface, above_m));
    }
    for (std::size_t k = 0; k < 4; ++k) {
        const MapPoint& from = result.corners[k];
        const MapPoint& to = result.corners[(k + 1) % 4];
        const double length = std::hypot(to.x - from.x, to.y - from.y);
        result.bulge_m =
            std::max(result.bulge_m, std::abs(side(from, to, middles[k])) / length);
    }
    if (signed_area(result.corners) < 0) {
        std::reverse(result.corners.begin(), result.corners.end());
    }
    return result;
}

} // namespace hsgm::geometry
