#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace hsgm::evaluate {

/// Bad pixels at one threshold. A pixel is bad where |test - truth| > threshold, strictly,
/// as Middlebury counts.
struct BadPixels {
    double threshold_px = 1;
    double bad_percent = 0;          ///< of all evaluated pixels; a missing answer is bad
    double bad_answered_percent = 0; ///< of the answered pixels
};

/// A disparity map against truth. Errors are test - truth in pixels; where nothing was
/// evaluated or answered, the figures that divide by it are NaN.
struct DisparityScore {
    std::int64_t evaluated = 0; ///< pixels with truth, inside the mask
    std::int64_t answered = 0;  ///< of these, with a value in the test
    double density_percent = 0; ///< answered / evaluated
    std::vector<BadPixels> bad;
    double mean_error_px = 0; ///< bias
    double mean_absolute_error_px = 0;
    double rmse_px = 0;
    double median_error_px = 0; ///< to 1/256 px, within +-128 px
    double nmad_px = 0;         ///< 1.4826 * median |error - median error|, likewise
};

/// Scores rows as they come; rows in any order give the same counts.
///
/// Medians come from a fixed histogram of errors, 1/256 px a bin (the matcher's sub-pixel
/// unit) over +-128 px; larger errors count in the outermost bins. This needs 512 KiB,
/// whatever the image's size.
class DisparityScorer {
public:
    /// Throws std::invalid_argument where a threshold is negative or not a number.
    explicit DisparityScorer(std::vector<double> thresholds_px = {0.5, 1, 2, 4});

    /// One row, all spans of one length. NaN (or infinity) = no value. `mask` may be empty;
    /// a pixel with mask 0 is not evaluated.
    void add_row(std::span<const float> test_px, std::span<const float> truth_px,
                 std::span<const std::uint8_t> mask = {});

    DisparityScore score() const;

private:
    void add_error(double error_px);
    double median_error_px() const;
    double median_deviation_px(double from_px) const;

    std::vector<double> thresholds_px_;
    std::vector<std::int64_t> bad_answered_;
    std::vector<std::int64_t> histogram_;
    std::int64_t evaluated_ = 0;
    std::int64_t answered_ = 0;
    double sum_ = 0;
    double sum_absolute_ = 0;
    double sum_squares_ = 0;
};

} // namespace hsgm::evaluate
