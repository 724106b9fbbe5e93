// Least squares matching of windows: F. Ackermann, Digital image correlation, The
// Photogrammetric Record 11(64), 1984.

#include "tests/unit/geometry/window_matching.h"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <optional>

namespace hsgm::geometry::samples {

namespace {

constexpr int kMaxSteps = 12;
constexpr double kDonePx = 0.003;
constexpr double kMostMovePx = 1.5;

/// Keys' cubic and its slope, for a fraction 0 <= t < 1 of a pixel.
struct Cubic {
    std::array<double, 4> weight;
    std::array<double, 4> slope;
    explicit Cubic(double t)
        : weight{-0.5 * t + t * t - 0.5 * t * t * t, 1 - 2.5 * t * t + 1.5 * t * t * t,
                 0.5 * t + 2 * t * t - 1.5 * t * t * t, -0.5 * t * t + 0.5 * t * t * t},
          slope{-0.5 + 2 * t - 1.5 * t * t, -5 * t + 4.5 * t * t, 0.5 + 4 * t - 4.5 * t * t,
                -t + 1.5 * t * t}
    {
    }
};

struct Sample {
    double value = 0;
    double by_row = 0;
    double by_col = 0;
};

/// The image between its pixels; NaN beside pixels without a value, nothing outside.
std::optional<Sample> sample(const FramePatch& patch, double row, double col)
{
    const double r = row - patch.row;
    const double c = col - patch.col;
    const double r0 = std::floor(r);
    const double c0 = std::floor(c);
    if (!(r0 >= 1 && c0 >= 1 && r0 + 2 < patch.pixels.rows() && c0 + 2 < patch.pixels.cols())) {
        return std::nullopt;
    }
    const Cubic down(r - r0);
    const Cubic across(c - c0);
    Sample s;
    for (std::size_t i = 0; i < 4; ++i) {
        const double* pixels =
            patch.pixels.row(static_cast<int>(r0) - 1 + static_cast<int>(i)) +
            static_cast<std::ptrdiff_t>(c0) - 1;
        double value = 0;
        double slope = 0;
        for (std::size_t j = 0; j < 4; ++j) {
            value += across.weight[j] * pixels[j];
            slope += across.slope[j] * pixels[j];
        }
        s.value += down.weight[i] * value;
        s.by_row += down.slope[i] * value;
        s.by_col += down.weight[i] * slope;
    }
    return s;
}

/// What moves the right window over the left one: a shift, how the disparity changes across
/// the window, and contrast.
using Parameters =
    Eigen::Matrix<double, 6, 1>; // row, col, col by row, col by col, gain, offset

class Window {
public:
    Window(const FramePatch& left, const FramePatch& right, FramePoint centre,
           FramePoint partner, int radius)
        : left_(left), right_(right), centre_(centre), partner_(partner), radius_(radius)
    {
    }

    /// One step of Gauss and Newton; false where a window is not whole.
    bool improve();
    FramePoint place() const { return {partner_.row + p_[0], partner_.col + p_[1]}; }
    double last_step_px() const { return last_step_px_; }
    double correlation() const { return correlation_; }
    /// Of the shift across the rows, by what the least squares leave over.
    double row_deviation_px() const { return row_deviation_px_; }

private:
    const FramePatch& left_;
    const FramePatch& right_;
    FramePoint centre_;
    FramePoint partner_;
    int radius_;
    Parameters p_ = Parameters::Zero();
    double last_step_px_ = 0;
    double correlation_ = 0;
    double row_deviation_px_ = 0;
};

bool Window::improve()
{
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Parameters right_side = Parameters::Zero();
    double n = 0;
    double squares = 0;
    double sum_a = 0;
    double sum_b = 0;
    double sum_aa = 0;
    double sum_bb = 0;
    double sum_ab = 0;
    for (int dr = -radius_; dr <= radius_; ++dr) {
        for (int dc = -radius_; dc <= radius_; ++dc) {
            const auto a = sample(left_, centre_.row + dr, centre_.col + dc);
            const auto b = sample(right_, partner_.row + p_[0] + dr,
                                  partner_.col + p_[1] + dc + p_[2] * dr + p_[3] * dc);
            if (!a || !b || std::isnan(a->value) || std::isnan(b->value)) {
                return false;
            }
            const double gain = 1 + p_[4];
            Parameters slope;
            slope << gain * b->by_row, gain * b->by_col, gain * b->by_col * dr,
                gain * b->by_col * dc, b->value, 1;
            const double rest = a->value - (gain * b->value + p_[5]);
            normal += slope * slope.transpose();
            right_side += slope * rest;
            squares += rest * rest;
            ++n;
            sum_a += a->value;
            sum_b += b->value;
            sum_aa += a->value * a->value;
            sum_bb += b->value * b->value;
            sum_ab += a->value * b->value;
        }
    }
    const double variance = (sum_aa - sum_a * sum_a / n) * (sum_bb - sum_b * sum_b / n);
    if (!(variance > 0)) {
        return false;
    }
    correlation_ = (sum_ab - sum_a * sum_b / n) / std::sqrt(variance);
    const auto solver = normal.ldlt();
    const Parameters step = solver.solve(right_side);
    row_deviation_px_ = std::sqrt(squares / (n - static_cast<double>(step.size())) *
                                  solver.solve(Parameters::Unit(0))[0]);
    if (!step.allFinite()) {
        return false;
    }
    p_ += step;
    last_step_px_ = std::hypot(step[0], step[1]);
    return true;
}

} // namespace

std::vector<TiePoint> match_windows(const std::vector<TiePoint>& points, const FramePatch& left,
                                    const FramePatch& right, int radius_px,
                                    double least_correlation, double most_deviation_px)
{
    std::vector<TiePoint> refined;
    for (const TiePoint& point : points) {
        // On a whole pixel the left window needs no interpolation.
        const FramePoint centre{std::floor(point.left.row + 0.5),
                                std::floor(point.left.col + 0.5)};
        const FramePoint partner{point.right.row + centre.row - point.left.row,
                                 point.right.col + centre.col - point.left.col};
        Window window(left, right, centre, partner, radius_px);
        bool whole = true;
        for (int step = 0; whole && step < kMaxSteps; ++step) {
            whole =
                window.improve() && std::hypot(window.place().row - partner.row,
                                               window.place().col - partner.col) <= kMostMovePx;
            if (whole && window.last_step_px() < kDonePx) {
                break;
            }
        }
        if (whole && window.last_step_px() < kDonePx &&
            window.correlation() >= least_correlation &&
            window.row_deviation_px() <= most_deviation_px) {
            refined.push_back({centre, window.place()});
        }
    }
    return refined;
}

} // namespace hsgm::geometry::samples
