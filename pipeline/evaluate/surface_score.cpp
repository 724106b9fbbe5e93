#include "pipeline/evaluate/surface_score.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace hsgm::evaluate {

namespace {

constexpr double kBinsPerMetre = 1000;
constexpr int kLargestBin = 100'000; // +-100 m
constexpr std::size_t kBins = 2 * kLargestBin + 1;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kNormal = 1.4826; // NMAD of a normal distribution is its standard deviation

int bin_of(double error_m)
{
    const double bin = std::floor(error_m * kBinsPerMetre + 0.5);
    return static_cast<int>(std::clamp<double>(bin, -kLargestBin, kLargestBin));
}

double percent(std::int64_t part, std::int64_t whole)
{
    return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : kNone;
}

} // namespace

SurfaceScorer::SurfaceScorer(std::vector<double> thresholds_m)
    : thresholds_m_(std::move(thresholds_m)), within_(thresholds_m_.size()), histogram_(kBins)
{
    for (const double threshold_m : thresholds_m_) {
        if (!(threshold_m >= 0)) {
            throw std::invalid_argument("a threshold is " + std::to_string(threshold_m) +
                                        "; allowed: 0 and up");
        }
    }
}

void SurfaceScorer::add(double error_m)
{
    ++evaluated_;
    if (!std::isfinite(error_m)) {
        return;
    }
    ++answered_;
    for (std::size_t i = 0; i < thresholds_m_.size(); ++i) {
        within_[i] += std::abs(error_m) <= thresholds_m_[i] ? 1 : 0;
    }
    ++histogram_[static_cast<std::size_t>(bin_of(error_m) + kLargestBin)];
    sum_ += error_m;
    sum_squares_ += error_m * error_m;
}

// The least whole number of bins r for which count(r) reaches that share of the answered.
template <typename Count>
double SurfaceScorer::least_reach_of(double share, Count count) const
{
    if (answered_ == 0) {
        return kNone;
    }
    const auto wanted =
        static_cast<std::int64_t>(std::ceil(share * static_cast<double>(answered_)));
    std::int64_t counted = 0;
    int reach = 0;
    for (; reach <= 2 * kLargestBin; ++reach) {
        counted += count(reach);
        if (counted >= wanted) {
            break;
        }
    }
    return reach / kBinsPerMetre;
}

double SurfaceScorer::median_m() const
{
    return least_reach_of(0.5, [&](int r) { return histogram_[static_cast<std::size_t>(r)]; }) -
           kLargestBin / kBinsPerMetre;
}

// Share of errors near `from_m`, its distance counted in bins.
double SurfaceScorer::median_distance_m(double from_m) const
{
    const int centre = std::isfinite(from_m) ? bin_of(from_m) + kLargestBin : 0;
    return least_reach_of(0.5, [&](int r) {
        const auto at = [&](int bin) {
            const bool inside = bin >= 0 && bin < static_cast<int>(kBins);
            return inside ? histogram_[static_cast<std::size_t>(bin)] : 0;
        };
        return at(centre - r) + (r > 0 ? at(centre + r) : 0);
    });
}

double SurfaceScorer::nmad_m() const
{
    return kNormal * median_distance_m(median_m());
}

double SurfaceScorer::le90_m() const
{
    return least_reach_of(0.9, [&](int r) {
        if (r > kLargestBin) {
            return std::int64_t{0};
        }
        const auto above = static_cast<std::size_t>(kLargestBin + r);
        const auto below = static_cast<std::size_t>(kLargestBin - r);
        return histogram_[above] + (r > 0 ? histogram_[below] : 0);
    });
}

SurfaceScore SurfaceScorer::score() const
{
    SurfaceScore s;
    s.evaluated = evaluated_;
    s.answered = answered_;
    s.completeness_percent = percent(answered_, evaluated_);
    for (std::size_t i = 0; i < thresholds_m_.size(); ++i) {
        s.within.push_back({thresholds_m_[i], percent(within_[i], evaluated_),
                            percent(within_[i], answered_)});
    }
    const auto count = static_cast<double>(answered_);
    s.mean_error_m = answered_ > 0 ? sum_ / count : kNone;
    s.rmse_m = answered_ > 0 ? std::sqrt(sum_squares_ / count) : kNone;
    s.median_error_m = median_m();
    s.nmad_m = nmad_m();
    s.le90_m = le90_m();
    return s;
}

} // namespace hsgm::evaluate
