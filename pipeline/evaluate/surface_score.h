#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace hsgm::evaluate {

/// Cells within one threshold of the reference.
struct WithinThreshold {
    double threshold_m = 1;
    double percent = 0;          ///< of all evaluated cells; a missing height is not within
    double answered_percent = 0; ///< of the cells with a height
};

/// A surface model against a reference. Errors are test - reference in metres (the unit of
/// the heights); where nothing was evaluated or answered, the figures that divide by it are
/// NaN.
struct SurfaceScore {
    std::int64_t evaluated = 0;      ///< cells with a reference that count
    std::int64_t answered = 0;       ///< of these, with a height in the test
    double completeness_percent = 0; ///< answered / evaluated
    std::vector<WithinThreshold> within;
    double mean_error_m = 0;
    double median_error_m = 0; ///< to 1 mm, within +-100 m
    double rmse_m = 0;
    double nmad_m = 0; ///< 1.4826 * median |error - median error|, likewise
    double le90_m = 0; ///< 90 % of the |errors| are at most this, likewise
};

/// Scores cells as they come; any order gives the same counts. Medians and LE90 come from a
/// histogram of errors with bins of 1 mm over +-100 m; larger errors count in the outermost
/// bins. This needs 1.6 MB.
class SurfaceScorer {
public:
    /// Throws std::invalid_argument where a threshold is negative or not a number.
    explicit SurfaceScorer(std::vector<double> thresholds_m = {0.5, 1, 2});

    /// One evaluated cell: its error, or NaN where the test has no height.
    void add(double error_m);

    SurfaceScore score() const;
    /// The median of the errors so far, and 1.4826 times their median distance from it; NaN
    /// without errors.
    double median_m() const;
    double nmad_m() const;

private:
    template <typename Count>
    double least_reach_of(double share, Count count) const;
    double median_distance_m(double from_m) const;
    double le90_m() const;

    std::vector<double> thresholds_m_;
    std::vector<std::int64_t> within_;
    std::vector<std::int64_t> histogram_;
    std::int64_t evaluated_ = 0;
    std::int64_t answered_ = 0;
    double sum_ = 0;
    double sum_squares_ = 0;
};

} // namespace hsgm::evaluate
