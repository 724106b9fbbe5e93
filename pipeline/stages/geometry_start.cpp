// What is known of a pair before a pixel is read.

#include "pipeline/stages/geometry_start.h"

#include "io/error.h"
#include "pipeline/geometry/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hsgm::pipeline {

namespace {

using geometry::HeightSpan;
using geometry::MapBox;
using geometry::SensorModel;

/// Buildings rise over a DEM, pits and errors of its own lie below it.
constexpr double kBelowDemM = 200;
constexpr double kAboveDemM = 500;
constexpr double kRoundPlaneM = 500;
/// Cells of the surface: wide against those of the matcher's frame, and not too many.
constexpr double kCellPx = 128;
constexpr double kMostCells = 64;

MapBox box_of(const SensorModel& model, tiling::Size size, const HeightSpan& heights)
{
    return model.ortho() != nullptr
               ? lonlat_box(*model.ortho())
               : lonlat_box(*model.rpc(), size, heights.low_m, heights.high_m);
}

} // namespace

HeightSpan possible_heights(const SensorModel& left, const SensorModel& right,
                            const PairGeometryOptions& options)
{
    if (options.heights) {
        return *options.heights;
    }
    if (options.dem) {
        return {options.dem->lowest_m() - kBelowDemM, options.dem->highest_m() + kAboveDemM};
    }
    if (left.rpc() != nullptr && right.rpc() != nullptr) {
        return geometry::heights_of(*left.rpc(), *right.rpc());
    }
    const double plane_m =
        options.ortho && options.ortho->plane_m ? *options.ortho->plane_m : 0;
    return {plane_m - kRoundPlaneM, plane_m + kRoundPlaneM};
}

HeightSpan heights_round(const geometry::ReliefSurface& relief,
                         const PairGeometryOptions& options)
{
    const double level_m = relief.surface.level_m();
    const HeightSpan above = options.above_dem.value_or(HeightSpan{-kBelowDemM, kAboveDemM});
    return {level_m + above.low_m + relief.dem_below_m,
            level_m + above.high_m + relief.dem_above_m};
}

std::optional<geometry::GeodeticPoint> middle_of(const SensorModel& model, tiling::Size size,
                                                 HeightSpan heights)
{
    if (const geometry::RpcModel* rpc = model.rpc()) {
        return geometry::RpcCamera(*rpc).locate({size.cols / 2.0, size.rows / 2.0},
                                                (heights.low_m + heights.high_m) / 2);
    }
    const MapBox box = lonlat_box(*model.ortho());
    return box.empty() ? std::nullopt
                       : std::optional(geometry::GeodeticPoint{(box.west + box.east) / 2,
                                                               (box.south + box.north) / 2, 0});
}

MapBox ground_box(const SensorImage& left, const SensorImage& right,
                  const PairGeometryOptions& options)
{
    const io::RasterSource left_source(left.image);
    const io::RasterSource right_source(right.image);
    const SensorModel left_model = open_sensor(left_source, left.image, options);
    const SensorModel right_model = open_sensor(right_source, right.image, options);
    const HeightSpan heights = possible_heights(left_model, right_model, options);
    const MapBox a = box_of(left_model, left_source.size(), heights);
    const MapBox b = box_of(right_model, right_source.size(), heights);
    const MapBox both{std::max(a.west, b.west), std::max(a.south, b.south),
                      std::min(a.east, b.east), std::min(a.north, b.north)};
    if (both.empty()) {
        const auto text = [](const MapBox& box) {
            return box.empty() ? "no ground at all"
                               : fmt::format("{:.4f} to {:.4f} degrees east, {:.4f} to {:.4f} "
                                             "north",
                                             box.west, box.east, box.south, box.north);
        };
        throw io::InputError(fmt::format("{} and {}: the images do not overlap: the left one "
                                         "shows {}, the right one {}",
                                         left.image.path, right.image.path, text(a), text(b)));
    }
    return both;
}

geometry::ReliefSurface relief_of(const geometry::ElevationGrid& dem,
                                  const geometry::MapProjection& map, const MapBox& degrees,
                                  double pixel_m, double least_cell_m)
{
    MapBox box = MapBox::nothing();
    for (const double longitude : {degrees.west, degrees.east}) {
        for (const double latitude : {degrees.south, degrees.north}) {
            const auto corner = map.forward({longitude, latitude, 0});
            box.include(corner.x, corner.y);
        }
    }
    const double side = std::max(box.width(), box.height());
    return geometry::relief_surface(
        dem, map, box, std::max({kCellPx * pixel_m, side / kMostCells, least_cell_m}));
}

double pixel_of(const geometry::GroundCamera& camera, tiling::Size size, HeightSpan heights)
{
    constexpr double kSpanPx = 16;
    const geometry::ImagePoint middle{size.cols / 2.0, size.rows / 2.0};
    const double height_m = (heights.low_m + heights.high_m) / 2;
    const auto here = camera.locate(middle, height_m);
    const auto there = camera.locate({middle.x + kSpanPx, middle.y}, height_m);
    if (!here || !there) {
        throw geometry::GeometryError(
            "the middle of the left image meets no ground: the RPC is that of another image");
    }
    return std::hypot(there->x - here->x, there->y - here->y) / kSpanPx;
}

} // namespace hsgm::pipeline
