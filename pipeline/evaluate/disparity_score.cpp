#include "pipeline/evaluate/disparity_score.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace hsgm::evaluate {

namespace {

constexpr int kBinsPerPixel = 256;
constexpr int kReach_px = 128;
constexpr int kZeroBin = kReach_px * kBinsPerPixel;
constexpr int kBins = 2 * kZeroBin + 1;

// Bin b holds the errors that round to (b - kZeroBin) / 256.
int bin_of(double error_px)
{
    const double bin = std::floor(error_px * kBinsPerPixel + 0.5) + kZeroBin;
    return static_cast<int>(std::clamp(bin, 0.0, kBins - 1.0));
}

double error_of(int bin)
{
    return static_cast<double>(bin - kZeroBin) / kBinsPerPixel;
}

double ratio(double numerator, std::int64_t denominator)
{
    return denominator == 0 ? std::numeric_limits<double>::quiet_NaN()
                            : numerator / static_cast<double>(denominator);
}

} // namespace

DisparityScorer::DisparityScorer(std::vector<double> thresholds_px)
    : thresholds_px_(std::move(thresholds_px)), bad_answered_(thresholds_px_.size()),
      histogram_(kBins)
{
    for (const double t : thresholds_px_) {
        if (!(t >= 0) || !std::isfinite(t)) {
            throw std::invalid_argument("threshold is " + std::to_string(t) +
                                        "; allowed: 0 and above, in pixels");
        }
    }
}

void DisparityScorer::add_row(std::span<const float> test_px, std::span<const float> truth_px,
                              std::span<const std::uint8_t> mask)
{
    assert(test_px.size() == truth_px.size());
    assert(mask.empty() || mask.size() == truth_px.size());
    for (std::size_t i = 0; i < truth_px.size(); ++i) {
        if (!std::isfinite(truth_px[i]) || (!mask.empty() && mask[i] == 0)) {
            continue;
        }
        ++evaluated_;
        if (std::isfinite(test_px[i])) {
            ++answered_;
            add_error(static_cast<double>(test_px[i]) - static_cast<double>(truth_px[i]));
        }
    }
}

void DisparityScorer::add_error(double error_px)
{
    const double size_px = std::abs(error_px);
    for (std::size_t k = 0; k < thresholds_px_.size(); ++k) {
        bad_answered_[k] += size_px > thresholds_px_[k];
    }
    ++histogram_[bin_of(error_px)];
    sum_ += error_px;
    sum_absolute_ += size_px;
    sum_squares_ += error_px * error_px;
}

// The lower median: the smallest error with at least half of the pixels at or below it.
double DisparityScorer::median_error_px() const
{
    std::int64_t below = 0;
    for (int bin = 0; bin < kBins; ++bin) {
        below += histogram_[bin];
        if (2 * below >= answered_) {
            return error_of(bin);
        }
    }
    return 0;
}

// The median distance from an error that is a bin's centre: bins counted outwards from it.
double DisparityScorer::median_deviation_px(double from_px) const
{
    const int centre = bin_of(from_px);
    std::int64_t within = histogram_[centre];
    int distance = 0;
    while (2 * within < answered_) {
        ++distance;
        within += centre - distance >= 0 ? histogram_[centre - distance] : 0;
        within += centre + distance < kBins ? histogram_[centre + distance] : 0;
    }
    return static_cast<double>(distance) / kBinsPerPixel;
}

DisparityScore DisparityScorer::score() const
{
    DisparityScore s;
    s.evaluated = evaluated_;
    s.answered = answered_;
    s.density_percent = ratio(100.0 * static_cast<double>(answered_), evaluated_);
    for (std::size_t k = 0; k < thresholds_px_.size(); ++k) {
        const std::int64_t bad = bad_answered_[k] + evaluated_ - answered_;
        s.bad.push_back({thresholds_px_[k], ratio(100.0 * static_cast<double>(bad), evaluated_),
                         ratio(100.0 * static_cast<double>(bad_answered_[k]), answered_)});
    }
    s.mean_error_px = ratio(sum_, answered_);
    s.mean_absolute_error_px = ratio(sum_absolute_, answered_);
    s.rmse_px = std::sqrt(ratio(sum_squares_, answered_));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    s.median_error_px = answered_ == 0 ? nan : median_error_px();
    s.nmad_px = answered_ == 0 ? nan : 1.4826 * median_deviation_px(s.median_error_px);
    return s;
}

} // namespace hsgm::evaluate
