#include "pipeline/evaluate/confidence_score.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace hsgm::evaluate {

namespace {

double ratio(double numerator, double denominator)
{
    return denominator == 0 ? std::numeric_limits<double>::quiet_NaN()
                            : numerator / denominator;
}

double bad_of(const ConfidenceClass& c)
{
    return static_cast<double>(c.pixels - c.within);
}

// Bad pixels among the `kept` most confident ones; of a class cut in two, its mean share.
double bad_among(const std::vector<ConfidenceClass>& rising, double kept)
{
    double bad = 0;
    for (auto c = rising.rbegin(); c != rising.rend() && kept > 0; ++c) {
        const auto pixels = static_cast<double>(c->pixels);
        bad += bad_of(*c) * std::min(1.0, kept / pixels);
        kept -= pixels;
    }
    return bad;
}

// The mean of bad(k) / k over k = 0..n pixels kept. Within a class of pixels a..b with a share
// r of bad ones, bad(k) = bad(a) + r (k - a), whose integral over dk / k is
// (bad(a) - r a) ln(b / a) + r (b - a).
double area_below(const std::vector<ConfidenceClass>& rising)
{
    double area = 0;
    double kept = 0;
    double bad = 0;
    for (auto c = rising.rbegin(); c != rising.rend(); ++c) {
        const auto pixels = static_cast<double>(c->pixels);
        const double share = bad_of(*c) / pixels;
        area += share * pixels;
        if (kept > 0) {
            area += (bad - share * kept) * std::log((kept + pixels) / kept);
        }
        kept += pixels;
        bad += bad_of(*c);
    }
    return ratio(area, kept);
}

double optimal_area(double bad_share)
{
    return bad_share < 1 ? bad_share + (1 - bad_share) * std::log(1 - bad_share) : bad_share;
}

} // namespace

ConfidenceScorer::ConfidenceScorer(double threshold_px) : threshold_px_(threshold_px)
{
    if (!(threshold_px >= 0) || !std::isfinite(threshold_px)) {
        throw std::invalid_argument("confidence threshold is " + std::to_string(threshold_px) +
                                    "; allowed: 0 and above, in pixels");
    }
}

void ConfidenceScorer::add_row(std::span<const float> test_px, std::span<const float> truth_px,
                               std::span<const float> confidence,
                               std::span<const std::uint8_t> mask)
{
    assert(test_px.size() == truth_px.size() && confidence.size() == truth_px.size());
    assert(mask.empty() || mask.size() == truth_px.size());
    for (std::size_t i = 0; i < truth_px.size(); ++i) {
        if (!std::isfinite(truth_px[i]) || !std::isfinite(test_px[i]) ||
            (!mask.empty() && mask[i] == 0)) {
            continue;
        }
        if (!(confidence[i] >= 0 && confidence[i] <= 255)) {
            throw std::invalid_argument("a pixel with a value has confidence " +
                                        std::to_string(confidence[i]) +
                                        "; allowed: numbers from 0 to 255");
        }
        const auto level = static_cast<std::size_t>(std::lround(confidence[i]));
        ++pixels_[level];
        const double error_px =
            static_cast<double>(test_px[i]) - static_cast<double>(truth_px[i]);
        within_[level] += std::abs(error_px) <= threshold_px_;
    }
}

ConfidenceScore ConfidenceScorer::score(std::span<const double> dropped_percent) const
{
    ConfidenceScore result;
    result.threshold_px = threshold_px_;
    for (std::size_t level = 0; level < pixels_.size(); ++level) {
        if (pixels_[level] > 0) {
            result.classes.push_back({static_cast<int>(level), pixels_[level], within_[level]});
            result.answered += pixels_[level];
        }
    }
    const auto answered = static_cast<double>(result.answered);
    for (const double dropped : dropped_percent) {
        const double kept = answered * (1 - dropped / 100);
        result.curve.push_back({dropped, 100 * ratio(bad_among(result.classes, kept), kept)});
    }
    result.area_percent = 100 * area_below(result.classes);
    result.optimal_area_percent =
        100 * optimal_area(ratio(bad_among(result.classes, answered), answered));
    for (const CalibrationRow& row : calibration(result)) {
        result.calibration_error +=
            row.share > 0 ? row.share * std::abs(row.confidence - row.within) : 0;
    }
    return result;
}

std::array<CalibrationRow, 10> calibration(const ConfidenceScore& score)
{
    struct Sums {
        double pixels = 0;
        double confidence = 0;
        double within = 0;
    };
    std::array<Sums, 10> sums{};
    for (const ConfidenceClass& c : score.classes) {
        const auto pixels = static_cast<double>(c.pixels);
        Sums& tenth = sums[static_cast<std::size_t>(std::min(c.confidence * 10 / 255, 9))];
        tenth.pixels += pixels;
        tenth.confidence += pixels * c.confidence / 255;
        tenth.within += static_cast<double>(c.within);
    }
    std::array<CalibrationRow, 10> rows{};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i] = {ratio(sums[i].pixels, static_cast<double>(score.answered)),
                   ratio(sums[i].confidence, sums[i].pixels),
                   ratio(sums[i].within, sums[i].pixels)};
    }
    return rows;
}

} // namespace hsgm::evaluate
