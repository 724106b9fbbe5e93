#include "pipeline/geometry/disparity_bounds.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hsgm::geometry {

namespace {

constexpr std::size_t kLeastPoints = 20;
constexpr double kPointsLeftOut = 0.02;
constexpr std::size_t kLeastPixels = 200;
constexpr double kPixelsLeftOut = 0.0005;
constexpr int kLeastFriends = 5;

// Between neighbours of sorted values.
double widest_gap(const std::vector<double>& values, std::size_t first, std::size_t last)
{
    double widest = 0;
    for (std::size_t i = first; i < last; ++i) {
        widest = std::max(widest, values[i + 1] - values[i]);
    }
    return widest;
}

DisparityBounds inner(std::vector<double>& values, double left_out)
{
    std::sort(values.begin(), values.end());
    const auto skip = static_cast<std::size_t>(left_out * static_cast<double>(values.size()));
    const std::size_t last = values.size() - 1 - skip;
    return {values[skip], values[last], widest_gap(values, skip, values.size() / 4),
            widest_gap(values, values.size() - 1 - values.size() / 4, last)};
}

int friends(tiling::ImageView<const float> d, int row, int col)
{
    int count = 0;
    for (int r = row - 1; r <= row + 1; ++r) {
        for (int c = col - 1; c <= col + 1; ++c) {
            // False for NaN.
            count += std::abs(d(r, c) - d(row, col)) <= 1.0F;
        }
    }
    return count - 1; // not of itself
}

} // namespace

std::optional<DisparityBounds> bounds_of(std::span<const TiePoint> points)
{
    if (points.size() < kLeastPoints) {
        return std::nullopt;
    }
    std::vector<double> values;
    for (const TiePoint& point : points) {
        values.push_back(point.disparity_px());
    }
    return inner(values, kPointsLeftOut);
}

std::optional<DisparityBounds> bounds_of(tiling::ImageView<const float> disparity_px)
{
    std::vector<double> values;
    for (int row = 1; row + 1 < disparity_px.rows(); ++row) {
        for (int col = 1; col + 1 < disparity_px.cols(); ++col) {
            const float d = disparity_px(row, col);
            if (!std::isnan(d) && friends(disparity_px, row, col) >= kLeastFriends) {
                values.push_back(double{d});
            }
        }
    }
    if (values.size() < kLeastPixels) {
        return std::nullopt;
    }
    return inner(values, kPixelsLeftOut);
}

} // namespace hsgm::geometry
