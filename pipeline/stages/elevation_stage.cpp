#include "pipeline/stages/elevation_stage.h"

#include "io/error.h"
#include "io/map_reference.h"
#include "io/raster_source.h"
#include "pipeline/geometry/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace hsgm::pipeline {

namespace {

using geometry::MapBox;
using geometry::MapGrid;
using geometry::MapPoint;
using geometry::MapProjection;
using tiling::Image;
using tiling::Rect;

constexpr int kMarginPosts = 3;
constexpr std::int64_t kMostPosts = std::int64_t{64} << 20;
constexpr int kAlongSide = 16; // places of a box that are turned into posts
constexpr int kStripRows = 256;

/// What its heights count from, for MapProjection; empty: the ellipsoid.
std::string vertical_of(const ElevationSpec& spec, bool file_says)
{
    return spec.vertical == "ellipsoid" || (spec.vertical.empty() && !file_says)
               ? ""
               : spec.vertical;
}

MapProjection projection(const ElevationSpec& spec, const std::string& wkt)
{
    const bool file_says = io::has_heights(wkt);
    try {
        // An answer of the user's stands for that of the file.
        return file_says && spec.vertical.empty()
                   ? MapProjection::from_text(wkt)
                   : MapProjection::from_text(io::horizontal_crs(wkt),
                                              vertical_of(spec, file_says));
    } catch (const std::invalid_argument& error) {
        throw io::ConfigError(fmt::format(
            "the heights of the reference DEM {} cannot be turned into heights above the "
            "ellipsoid: {}; install the grid, or say with geometry.reference_dem_vertical "
            "what they count from",
            spec.path, error.what()));
    }
}

MapGrid grid_of(const io::RasterSource& source)
{
    const io::GeoReference geo = source.geo_reference();
    if (!geo.transform || geo.wkt.empty()) {
        throw io::InputError(fmt::format(
            "the reference DEM {} lies on no map: it has no {}", source.description(),
            geo.transform ? "coordinate reference system" : "geotransform"));
    }
    try {
        return MapGrid(*geo.transform);
    } catch (const geometry::GeometryError& error) {
        throw io::InputError(
            fmt::format("the reference DEM {}: {}", source.description(), error.what()));
    }
}

/// The posts over a box, inside the file; perhaps none.
Rect posts_over(const MapBox& degrees, const MapGrid& grid, const MapProjection& map,
                tiling::Size file)
{
    double least_col = std::numeric_limits<double>::infinity();
    double least_row = least_col;
    double most_col = -least_col;
    double most_row = -least_col;
    for (int i = 0; i <= kAlongSide; ++i) {
        for (int j = 0; j <= kAlongSide; ++j) {
            const MapPoint place =
                map.forward({degrees.west + degrees.width() * j / kAlongSide,
                             degrees.south + degrees.height() * i / kAlongSide, 0});
            const geometry::ImagePoint post = grid.pixel_of(place.x, place.y);
            if (std::isfinite(post.x) && std::isfinite(post.y)) {
                least_col = std::min(least_col, post.x);
                most_col = std::max(most_col, post.x);
                least_row = std::min(least_row, post.y);
                most_row = std::max(most_row, post.y);
            }
        }
    }
    if (!(least_col <= most_col)) {
        return {};
    }
    const auto first = [](double at) {
        return static_cast<int>(std::clamp(std::floor(at) - kMarginPosts, -1e9, 1e9));
    };
    const auto end = [](double at) {
        return static_cast<int>(std::clamp(std::ceil(at) + kMarginPosts + 1, -1e9, 1e9));
    };
    return intersect(
        tiling::rect_between(first(least_row), first(least_col), end(most_row), end(most_col)),
        rect_of(file));
}

/// Reads heights and turns them into those above the ellipsoid, some rows at a time.
Image<float> read_posts(io::RasterSource& source, const Rect& window, const MapGrid& grid,
                        const MapProjection& map)
{
    Image<float> posts(window.size());
    for (int row = window.row; row < window.row_end(); row += kStripRows) {
        const Rect strip = intersect({row, window.col, kStripRows, window.cols}, window);
        Image<double> heights(strip.size());
        source.read(strip, heights);
        for (int r = 0; r < strip.rows; ++r) {
            for (int c = 0; c < strip.cols; ++c) {
                MapPoint place = grid.place_of({double(strip.col + c), double(strip.row + r)});
                place.height_m = heights(r, c);
                const double height =
                    std::isnan(place.height_m) ? place.height_m : map.inverse(place).height_m;
                posts(strip.row - window.row + r, c) =
                    std::isfinite(height) ? static_cast<float>(height)
                                          : std::numeric_limits<float>::quiet_NaN();
            }
        }
    }
    return posts;
}

MapGrid part_of(const MapGrid& grid, const Rect& window)
{
    auto transform = grid.corner_transform();
    const MapPoint corner = grid.place_of({window.col - 0.5, window.row - 0.5});
    transform[0] = corner.x;
    transform[3] = corner.y;
    return MapGrid(transform);
}

std::string text_of(const MapBox& degrees)
{
    return fmt::format("{:.4f} to {:.4f} degrees east, {:.4f} to {:.4f} north", degrees.west,
                       degrees.east, degrees.south, degrees.north);
}

[[noreturn]] void refuse_uncovered(const io::RasterSource& source, const MapProjection& map,
                                   const MapGrid& grid, const MapBox& degrees)
{
    MapBox own = MapBox::nothing();
    const tiling::Size size = source.size();
    for (const double x : {-0.5, size.cols - 0.5}) {
        for (const double y : {-0.5, size.rows - 0.5}) {
            const geometry::GeodeticPoint corner = map.inverse(grid.place_of({x, y}));
            own.include(corner.longitude_deg, corner.latitude_deg);
        }
    }
    throw io::InputError(fmt::format("the reference DEM {} has no height where the images lie, "
                                     "{}; it covers {}",
                                     source.description(), text_of(degrees), text_of(own)));
}

} // namespace

Elevation read_elevation(const ElevationSpec& spec, const MapBox& degrees)
{
    io::RasterSource source(io::ImageSpec{spec.path, 1});
    const MapGrid grid = grid_of(source);
    const std::string wkt = source.geo_reference().wkt;
    const MapProjection map = projection(spec, wkt);
    const Rect window = posts_over(degrees, grid, map, source.size());
    if (window.empty()) {
        refuse_uncovered(source, map, grid, degrees);
    }
    if (window.area() > kMostPosts) {
        throw io::InputError(fmt::format(
            "the reference DEM {} has {} x {} posts where the images lie, more than {} Mi; "
            "give a coarser one (gdal_translate -r average -tr ...)",
            source.description(), window.cols, window.rows, kMostPosts >> 20));
    }
    Elevation elevation;
    elevation.grid = std::make_shared<geometry::ElevationGrid>(
        part_of(grid, window), io::horizontal_crs(wkt), read_posts(source, window, grid, map));
    if (std::isnan(elevation.grid->middle_m())) {
        refuse_uncovered(source, map, grid, degrees);
    }
    if (spec.vertical.empty() && !io::has_heights(wkt)) {
        elevation.warning = fmt::format(
            "{} does not say what its heights count from; they are taken as heights above the "
            "ellipsoid (geometry.reference_dem_vertical says otherwise, EGM96 for example)",
            source.description());
    }
    return elevation;
}

void check_vertical(const std::string& vertical)
{
    if (!vertical.empty() && vertical != "ellipsoid") {
        MapProjection::from_text("EPSG:32631", vertical);
    }
}

} // namespace hsgm::pipeline
