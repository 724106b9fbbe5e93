#include "pipeline/evaluate/coregistration.h"

#include <algorithm>
#include <cmath>

namespace hsgm::evaluate {

void ShiftFit::add(double difference_m, double slope_east, double slope_north)
{
    if (!(std::abs(difference_m - centre_m_) <= limit_m_) || !std::isfinite(slope_east) ||
        !std::isfinite(slope_north)) {
        return;
    }
    ++cells_;
    const std::array<double, 3> row{-slope_east, -slope_north, 1};
    std::size_t k = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = i; j < 3; ++j) {
            normal_[k++] += row[i] * row[j];
        }
        right_[i] += row[i] * difference_m;
    }
}

std::optional<double> ShiftFit::up() const
{
    if (cells_ == 0) {
        return std::nullopt;
    }
    return right_[2] / static_cast<double>(cells_);
}

ShiftFit::Moments ShiftFit::moments() const
{
    const auto n = static_cast<double>(cells_);
    return {normal_[0] - normal_[2] * normal_[2] / n, normal_[1] - normal_[2] * normal_[4] / n,
            normal_[3] - normal_[4] * normal_[4] / n};
}

double ShiftFit::weakest_slope() const
{
    if (cells_ == 0) {
        return 0;
    }
    const auto [ee, en, nn] = moments();
    const double least = (ee + nn - std::hypot(ee - nn, 2 * en)) / 2; // eigenvalue
    return std::sqrt(std::max(least, 0.0) / static_cast<double>(cells_));
}

std::optional<SurfaceShift> ShiftFit::shift() const
{
    if (cells_ < 3 || weakest_slope() < kLeastSlope) {
        return std::nullopt;
    }
    // The height taken out first, what is left is two by two.
    const auto n = static_cast<double>(cells_);
    const auto [ee, en, nn] = moments();
    const double e = right_[0] - normal_[2] * right_[2] / n;
    const double nr = right_[1] - normal_[4] * right_[2] / n;
    const double determinant = ee * nn - en * en;
    // Variances for noise of 1 m are nn / determinant and ee / determinant.
    if (!(determinant > 0) || nn > determinant || ee > determinant) {
        return std::nullopt;
    }
    SurfaceShift found;
    found.east = (nn * e - en * nr) / determinant;
    found.north = (ee * nr - en * e) / determinant;
    found.up = (right_[2] - normal_[2] * found.east - normal_[4] * found.north) / n;
    return found;
}

} // namespace hsgm::evaluate
