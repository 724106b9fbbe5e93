#include "pipeline/stages/region_stage.h"

#include "io/error.h"
#include "io/vector_areas.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace hsgm::pipeline {

namespace {

using geometry::MapPoint;
using geometry::MapProjection;
using geometry::Polygon;

constexpr int kPiecesOfSide = 16;

struct Source {
    std::vector<std::vector<std::array<double, 2>>> rings;
    MapProjection map;
    std::string name; ///< for messages
};

Source source_of(const RegionOptions& region, const MapProjection& map)
{
    if (region.bounds) {
        const auto [west, south, east, north] = *region.bounds;
        return {{{{west, south}, {east, south}, {east, north}, {west, north}}},
                region.bounds_crs.empty() ? map.copy()
                                          : MapProjection::from_text(region.bounds_crs),
                "dsm.bounds"};
    }
    io::VectorAreas areas = io::read_areas(region.file);
    if (areas.wkt.empty()) {
        throw io::InputError(
            fmt::format("the region of interest {} has no coordinate reference "
                        "system, so nobody knows where it lies; give it one "
                        "(ogr2ogr -a_srs), or use dsm.bounds",
                        region.file));
    }
    try {
        return {std::move(areas.rings), MapProjection::from_text(areas.wkt), region.file};
    } catch (const std::invalid_argument& error) {
        throw io::InputError(fmt::format("the reference system of the region of interest {} "
                                         "cannot be used: {}",
                                         region.file, error.what()));
    }
}

double turn(const MapPoint& a, const MapPoint& b, const MapPoint& c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// One side of the hull of sorted corners (Andrew's monotone chain).
template <typename Corners>
Polygon chain(const Corners& begin, const Corners& end)
{
    Polygon side;
    for (auto corner = begin; corner != end; ++corner) {
        while (side.size() >= 2 && turn(side[side.size() - 2], side.back(), *corner) <= 0) {
            side.pop_back();
        }
        side.push_back(*corner);
    }
    side.pop_back();
    return side;
}

} // namespace

std::vector<Polygon> region_deg(const RegionOptions& region, const MapProjection& map)
{
    const Source source = source_of(region, map);
    std::vector<Polygon> result;
    for (const auto& ring : source.rings) {
        Polygon& polygon = result.emplace_back();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const auto& from = ring[i];
            const auto& to = ring[(i + 1) % ring.size()];
            for (int piece = 0; piece < kPiecesOfSide; ++piece) {
                const double t = static_cast<double>(piece) / kPiecesOfSide;
                const auto ground = source.map.inverse(
                    {from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]), 0});
                if (!std::isfinite(ground.longitude_deg) ||
                    !std::isfinite(ground.latitude_deg)) {
                    throw io::InputError(
                        fmt::format("the region of interest ({}) reaches x {:g}, y {:g}, which "
                                    "is no place in {}",
                                    source.name, from[0], from[1], source.map.name()));
                }
                polygon.push_back({ground.longitude_deg, ground.latitude_deg, 0});
            }
        }
    }
    return result;
}

std::shared_ptr<const dsm::CellArea> region_on(const std::vector<Polygon>& region_deg,
                                               const MapProjection& map)
{
    std::vector<dsm::Ring> rings;
    for (const Polygon& polygon : region_deg) {
        dsm::Ring& ring = rings.emplace_back();
        for (const MapPoint& corner : polygon) {
            const MapPoint place = map.forward({corner.x, corner.y, 0});
            ring.push_back({place.x, place.y});
        }
    }
    return std::make_shared<dsm::CellArea>(std::move(rings));
}

Polygon convex_hull(std::vector<MapPoint> corners, double margin)
{
    std::vector<MapPoint> all;
    for (const MapPoint& corner : corners) {
        for (const double x : {-margin, margin}) {
            for (const double y : {-margin, margin}) {
                all.push_back({corner.x + x, corner.y + y, 0});
            }
        }
    }
    std::sort(all.begin(), all.end(), [](const MapPoint& a, const MapPoint& b) {
        return std::tie(a.x, a.y) < std::tie(b.x, b.y);
    });
    Polygon hull = chain(all.begin(), all.end());
    const Polygon back = chain(all.rbegin(), all.rend());
    hull.insert(hull.end(), back.begin(), back.end());
    return hull;
}

} // namespace hsgm::pipeline
