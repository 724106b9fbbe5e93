#include "pipeline/geometry/reference_surface.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace hsgm::geometry {

namespace {

/// Weights of the four control points round a place at `t` of its cell, 0 <= t <= 1.
std::array<double, 4> spline(double t)
{
    const double s = 1 - t;
    return {s * s * s / 6, (4 - 6 * t * t + 3 * t * t * t) / 6,
            (4 - 6 * s * s + 3 * s * s * s) / 6, t * t * t / 6};
}

std::array<double, 4> spline_slope(double t)
{
    const double s = 1 - t;
    return {-s * s / 2, (3 * t * t - 4 * t) / 2, (4 * s - 3 * s * s) / 2, t * t / 2};
}

/// The cell that holds `position` (in steps). Control points beyond the outermost ones repeat
/// them, so the surface goes on smoothly and is level from two steps outside on.
struct Cell {
    int first = 0; // of its four control points, may lie outside and is clamped there
    double t = 0;
};

Cell cell_of(double position, int count)
{
    const double near = std::clamp(position, -3.0, static_cast<double>(count + 2));
    const double cell = std::floor(near);
    return {static_cast<int>(cell) - 1, near - cell};
}

} // namespace

ReferenceSurface::ReferenceSurface(double west, double north, double step_m,
                                   tiling::Image<double> posts)
    : west_(west), north_(north), step_m_(step_m), posts_(std::move(posts))
{
    assert(posts_.rows() >= 4 && posts_.cols() >= 4 && step_m > 0);
    double sum = 0;
    for (const double height : posts_.pixels()) {
        sum += height;
    }
    level_m_ = sum / static_cast<double>(posts_.size().area());
}

ReferenceSurface ReferenceSurface::lifted(double by_m) const
{
    if (is_level()) {
        return ReferenceSurface(level_m_ + by_m);
    }
    tiling::Image<double> posts = posts_;
    for (std::int64_t i = 0; i < posts.size().area(); ++i) {
        posts.data()[i] += by_m;
    }
    return {west_, north_, step_m_, std::move(posts)};
}

double ReferenceSurface::height_m(double x, double y) const
{
    double slope_x = 0;
    double slope_y = 0;
    return height_m(x, y, slope_x, slope_y);
}

double ReferenceSurface::height_m(double x, double y, double& slope_x, double& slope_y) const
{
    slope_x = 0;
    slope_y = 0;
    if (is_level()) {
        return level_m_;
    }
    const double east = (x - west_) / step_m_;
    const double south = (north_ - y) / step_m_;
    const Cell col = cell_of(east, posts_.cols());
    const Cell row = cell_of(south, posts_.rows());
    const auto across = spline(col.t);
    const auto across_slope = spline_slope(col.t);
    const auto down = spline(row.t);
    const auto down_slope = spline_slope(row.t);
    double height = 0;
    for (int r = 0; r < 4; ++r) {
        const double* posts = posts_.row(std::clamp(row.first + r, 0, posts_.rows() - 1));
        double value = 0;
        double value_slope = 0;
        for (int c = 0; c < 4; ++c) {
            const double post = posts[std::clamp(col.first + c, 0, posts_.cols() - 1)];
            value += across[static_cast<std::size_t>(c)] * post;
            value_slope += across_slope[static_cast<std::size_t>(c)] * post;
        }
        const auto k = static_cast<std::size_t>(r);
        height += down[k] * value;
        slope_x += down[k] * value_slope;
        slope_y -= down_slope[k] * value;
    }
    slope_x /= step_m_;
    slope_y /= step_m_;
    return height;
}

} // namespace hsgm::geometry
