#include "pipeline/geometry/relief_surface.h"

#include "pipeline/geometry/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hsgm::geometry {

namespace {

using tiling::Image;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kSides = 2;       // posts beyond the box
constexpr int kMostSamples = 8; // of a cell, each way

/// Heights of the DEM at places of another map.
class Sampler {
public:
    Sampler(const ElevationGrid& dem, const MapProjection& map)
        : dem_(dem), map_(map), dem_map_(MapProjection::from_text(dem.crs()))
    {
    }
    double at(double x, double y) const
    {
        const MapPoint place = dem_map_.forward(map_.inverse({x, y, dem_.middle_m()}));
        return dem_.height_m(dem_.grid().pixel_of(place.x, place.y));
    }
    /// Posts of the DEM to a cell of that size, about.
    double posts_in(double x, double y, double step_m) const
    {
        const auto pixel = [&](double px, double py) {
            const MapPoint place = dem_map_.forward(map_.inverse({px, py, dem_.middle_m()}));
            return dem_.grid().pixel_of(place.x, place.y);
        };
        const ImagePoint a = pixel(x, y);
        const ImagePoint b = pixel(x + step_m, y);
        return std::hypot(b.x - a.x, b.y - a.y);
    }

private:
    const ElevationGrid& dem_;
    const MapProjection& map_;
    MapProjection dem_map_;
};

double mean_of_cell(const Sampler& dem, double x, double y, double step_m, int samples)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < samples * samples; ++i) {
        const double right = (i % samples + 0.5) / samples - 0.5;
        const double down = (i / samples + 0.5) / samples - 0.5;
        const double height = dem.at(x + right * step_m, y - down * step_m);
        if (!std::isnan(height)) {
            sum += height;
            ++count;
        }
    }
    return count > 0 ? sum / count : kNone;
}

/// Notes how far the DEM leaves the surface between the posts.
void compare(const Sampler& dem, int samples, ReliefSurface& relief)
{
    const ReferenceSurface& surface = relief.surface;
    const double step_m = surface.step_m() / (2 * samples);
    const int rows = 2 * samples * surface.posts().rows();
    const int cols = 2 * samples * surface.posts().cols();
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < cols; ++j) {
            const double x = surface.west() + j * step_m;
            const double y = surface.north() - i * step_m;
            const double above = dem.at(x, y) - surface.height_m(x, y);
            if (!std::isnan(above)) {
                relief.dem_below_m = std::min(relief.dem_below_m, above);
                relief.dem_above_m = std::max(relief.dem_above_m, above);
            }
        }
    }
}

/// The mean of those of the eight neighbours that have a height.
double mean_of_neighbours(const Image<double>& posts, int row, int col)
{
    double sum = 0;
    int count = 0;
    for (int r = std::max(row - 1, 0); r <= std::min(row + 1, posts.rows() - 1); ++r) {
        for (int c = std::max(col - 1, 0); c <= std::min(col + 1, posts.cols() - 1); ++c) {
            if (!std::isnan(posts(r, c))) {
                sum += posts(r, c);
                ++count;
            }
        }
    }
    return count > 0 ? sum / count : kNone;
}

/// From the known posts outwards, a ring at a time.
void fill_gaps(Image<double>& posts)
{
    for (bool gaps = true; gaps;) {
        gaps = false;
        const Image<double> before = posts;
        for (int r = 0; r < posts.rows(); ++r) {
            for (int c = 0; c < posts.cols(); ++c) {
                if (std::isnan(before(r, c))) {
                    posts(r, c) = mean_of_neighbours(before, r, c);
                    gaps = gaps || std::isnan(posts(r, c));
                }
            }
        }
    }
}

} // namespace

MapBox MapBox::nothing()
{
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return {kFar, kFar, -kFar, -kFar};
}

void MapBox::include(double x, double y)
{
    west = std::min(west, x);
    east = std::max(east, x);
    south = std::min(south, y);
    north = std::max(north, y);
}

ReliefSurface relief_surface(const ElevationGrid& dem, const MapProjection& map,
                             const MapBox& box, double step_m)
{
    const auto count = [&](double length) {
        return static_cast<int>(std::ceil(length / step_m)) + 1 + 2 * kSides;
    };
    Image<double> posts({count(box.height()), count(box.width())});
    const double west = box.west - kSides * step_m;
    const double north = box.north + kSides * step_m;
    const Sampler sampler(dem, map);
    const double per_cell =
        sampler.posts_in((box.west + box.east) / 2, (box.south + box.north) / 2, step_m);
    const int samples = std::clamp(
        static_cast<int>(std::lround(std::isfinite(per_cell) ? per_cell : 1)), 1, kMostSamples);
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    int known = 0;
    int inside = 0;
    for (int r = 0; r < posts.rows(); ++r) {
        for (int c = 0; c < posts.cols(); ++c) {
            const double height =
                mean_of_cell(sampler, west + c * step_m, north - r * step_m, step_m, samples);
            posts(r, c) = height;
            if (r >= kSides && r < posts.rows() - kSides && c >= kSides &&
                c < posts.cols() - kSides) {
                ++inside;
                known += !std::isnan(height);
            }
            if (!std::isnan(height)) {
                lowest = std::min(lowest, height);
                highest = std::max(highest, height);
            }
        }
    }
    if (known == 0) {
        throw GeometryError(
            "the reference DEM has no height anywhere in what both images show");
    }
    fill_gaps(posts);
    ReliefSurface relief{ReferenceSurface(west, north, step_m, std::move(posts)),
                         static_cast<double>(known) / inside, lowest, highest};
    compare(sampler, samples, relief);
    return relief;
}

} // namespace hsgm::geometry
