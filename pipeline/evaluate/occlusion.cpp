#include "pipeline/evaluate/occlusion.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace hsgm::evaluate {

namespace {

constexpr int kOutside = -1;

// The right column on which a left pixel lands, or kOutside; so too where d is unknown.
int landing_column(std::size_t col, float disparity_px, std::size_t right_cols)
{
    const double landing = std::floor(static_cast<double>(col) - disparity_px + 0.5);
    // Written so that NaN fails.
    if (!(landing >= 0 && landing < static_cast<double>(right_cols))) {
        return kOutside;
    }
    return static_cast<int>(landing);
}

} // namespace

void nonoccluded_by_cross_check(std::span<const float> truth_left_px,
                                std::span<const float> truth_right_px,
                                std::span<std::uint8_t> nonoccluded, double tolerance_px)
{
    assert(nonoccluded.size() == truth_left_px.size());
    for (std::size_t col = 0; col < truth_left_px.size(); ++col) {
        const float d = truth_left_px[col];
        const int landing = landing_column(col, d, truth_right_px.size());
        const bool agrees =
            landing != kOutside &&
            std::abs(static_cast<double>(d) - truth_right_px[landing]) <= tolerance_px;
        nonoccluded[col] = agrees ? 255 : 0;
    }
}

void nonoccluded_by_zbuffer(std::span<const float> truth_left_px, int right_cols,
                            std::span<std::uint8_t> nonoccluded, double tolerance_px)
{
    assert(nonoccluded.size() == truth_left_px.size());
    const auto cols = static_cast<std::size_t>(right_cols);
    std::vector<float> nearest(cols, -std::numeric_limits<float>::infinity());
    for (std::size_t col = 0; col < truth_left_px.size(); ++col) {
        const int landing = landing_column(col, truth_left_px[col], cols);
        if (landing != kOutside) {
            nearest[landing] = std::max(nearest[landing], truth_left_px[col]);
        }
    }
    for (std::size_t col = 0; col < truth_left_px.size(); ++col) {
        const float d = truth_left_px[col];
        const int landing = landing_column(col, d, cols);
        const bool hidden =
            landing == kOutside || static_cast<double>(nearest[landing]) - d > tolerance_px;
        nonoccluded[col] = hidden ? 0 : 255;
    }
}

} // namespace hsgm::evaluate
