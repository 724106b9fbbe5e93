#include "pipeline/geometry/elevation_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hsgm::geometry {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// (1 - t) a + t b, where a weight of 0 makes even a missing value count for nothing.
double mixed(double a, double b, double t)
{
    return t == 0 ? a : t == 1 ? b : (1 - t) * a + t * b;
}

} // namespace

ElevationGrid::ElevationGrid(MapGrid grid, std::string crs, tiling::Image<float> posts)
    : grid_(grid), crs_(std::move(crs)), posts_(std::move(posts)), lowest_m_(kNone),
      highest_m_(kNone)
{
    for (const float post : posts_.pixels()) {
        if (!std::isnan(post)) {
            const double height = double{post};
            lowest_m_ = std::isnan(lowest_m_) ? height : std::min(lowest_m_, height);
            highest_m_ = std::isnan(highest_m_) ? height : std::max(highest_m_, height);
        }
    }
}

double ElevationGrid::height_m(ImagePoint post) const
{
    const double right = posts_.cols() - 1;
    const double bottom = posts_.rows() - 1;
    // False for NaN.
    if (!(post.x >= -0.5 && post.x <= right + 0.5 && post.y >= -0.5 &&
          post.y <= bottom + 0.5)) {
        return kNone;
    }
    const double x = std::clamp(post.x, 0.0, right);
    const double y = std::clamp(post.y, 0.0, bottom);
    const int col = static_cast<int>(x);
    const int row = static_cast<int>(y);
    const int next_col = std::min(col + 1, posts_.cols() - 1);
    const int next_row = std::min(row + 1, posts_.rows() - 1);
    const double across = x - col;
    const auto along = [&](int r) {
        return mixed(double{posts_(r, col)}, double{posts_(r, next_col)}, across);
    };
    return mixed(along(row), along(next_row), y - row);
}

} // namespace hsgm::geometry
