#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hsgm::evaluate {

/// Bad pixels among the most confident ones.
struct Sparsified {
    double dropped_percent = 0; ///< of the answered pixels, the least confident first
    double bad_percent = 0;     ///< of those kept
};

/// Answered pixels of one stored confidence.
struct ConfidenceClass {
    int confidence = 0; ///< 0..255
    std::int64_t pixels = 0;
    std::int64_t within = 0; ///< of these, not bad
};

/// What a confidence is worth against truth (Hu and Mordohai, PAMI 34(11), 2012). A pixel is
/// bad where |test - truth| > threshold_px. Figures that divide by no pixels are NaN.
struct ConfidenceScore {
    double threshold_px = 1;
    std::int64_t answered = 0; ///< pixels with truth and value, inside the mask
    std::vector<Sparsified> curve;
    /// Mean over all shares dropped of the bad pixels among those kept, and the least that any
    /// confidence could reach: e + (1 - e) ln(1 - e), e the share of bad pixels.
    double area_percent = 0;
    double optimal_area_percent = 0;
    /// Mean distance of confidence / 255 and the share within the threshold, over the ten
    /// classes of a tenth each, weighted by their pixels.
    double calibration_error = 0;
    std::vector<ConfidenceClass> classes; ///< those that have pixels, rising
};

/// Scores rows as they come, in any order. Pixels of equal confidence are dropped in random
/// order: the expected figure counts.
class ConfidenceScorer {
public:
    /// Throws std::invalid_argument where the threshold is negative or not a number.
    explicit ConfidenceScorer(double threshold_px = 1);

    /// One row, all spans of one length; NaN (or infinity) = no value. `mask` may be empty; a
    /// pixel with mask 0 is not evaluated. Throws std::invalid_argument for the confidence of
    /// an answered pixel that is no number from 0 to 255.
    void add_row(std::span<const float> test_px, std::span<const float> truth_px,
                 std::span<const float> confidence, std::span<const std::uint8_t> mask = {});

    /// The curve at these shares, in percent, below 100.
    ConfidenceScore score(std::span<const double> dropped_percent) const;

private:
    double threshold_px_;
    std::array<std::int64_t, 256> pixels_{};
    std::array<std::int64_t, 256> within_{};
};

/// Share of answered pixels, mean confidence and share within the threshold of a tenth of the
/// scale.
struct CalibrationRow {
    double share = 0;
    double confidence = 0; ///< mean, 0..1
    double within = 0;     ///< 0..1
};
/// Tenth i holds confidences of i / 10 to (i + 1) / 10 of 255; its figures are NaN where it has
/// no pixels.
std::array<CalibrationRow, 10> calibration(const ConfidenceScore& score);

} // namespace hsgm::evaluate
