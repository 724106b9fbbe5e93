#include "pipeline/geometry/pointing.h"

#include "pipeline/geometry/error.h"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hsgm::geometry {

namespace {

constexpr int kLeastInliers = 20;
constexpr int kFewInliers = 60;
constexpr double kMostRms = 1.0;
constexpr double kHighRms = 0.5;
constexpr double kClusterPx = 1.0;   // width of the cluster that starts the search
constexpr double kLeastGatePx = 0.3; // inliers are never asked to be nearer than that
constexpr int kMaxRounds = 30;
/// An affine correction must be worth it and well supported.
constexpr double kAffineGain = 0.9;
constexpr double kAffineSpread = 0.4;
constexpr double kAffineMostPx = 5;

/// A tie point in the right image: where it is, and how far off its epipolar line.
struct Observation {
    double x = 0;
    double y = 0;
    double off_px = 0;
};

/// off_px = a + b x + c y
struct Fit {
    Eigen::Vector3d abc = Eigen::Vector3d::Zero();
    std::vector<bool> inlier;
    int inliers = 0;
    double rms_px = 0;

    double at(const Observation& o) const { return abc[0] + abc[1] * o.x + abc[2] * o.y; }
};

double length(ImagePoint p)
{
    return std::hypot(p.x, p.y);
}

/// Across the epipolar line through a place of the right image; downwards on the frame.
ImagePoint across_line(const EpipolarFrame& frame, FramePoint place)
{
    constexpr double kStepPx = 8;
    const ImagePoint a = frame.right_at({place.row, place.col - kStepPx});
    const ImagePoint b = frame.right_at({place.row, place.col + kStepPx});
    const ImagePoint below = frame.right_at({place.row + kStepPx, place.col});
    const ImagePoint along{b.x - a.x, b.y - a.y};
    const double size = length(along);
    ImagePoint normal{-along.y / size, along.x / size};
    const double down = normal.x * (below.x - a.x) + normal.y * (below.y - a.y);
    return down >= 0 ? normal : ImagePoint{-normal.x, -normal.y};
}

std::vector<Observation> observe(const EpipolarFrame& frame, std::span<const TiePoint> points,
                                 ImagePoint across)
{
    std::vector<Observation> all;
    for (const TiePoint& point : points) {
        const ImagePoint seen = frame.right_at(point.right);
        const ImagePoint expected = frame.right_at({point.left.row, point.right.col});
        all.push_back({seen.x, seen.y,
                       across.x * (seen.x - expected.x) + across.y * (seen.y - expected.y)});
    }
    return all;
}

/// The middle of the densest cluster of distances.
double densest(const std::vector<Observation>& all)
{
    std::vector<double> sorted;
    for (const Observation& o : all) {
        sorted.push_back(o.off_px);
    }
    std::sort(sorted.begin(), sorted.end());
    std::size_t best = 0;
    double centre = 0;
    for (std::size_t first = 0, last = 0; first < sorted.size(); ++first) {
        while (last < sorted.size() && sorted[last] <= sorted[first] + kClusterPx) {
            ++last;
        }
        if (last - first > best) {
            best = last - first;
            centre = sorted[(first + last) / 2];
        }
    }
    return centre;
}

/// Chooses those within three robust deviations of the fit; true where that changed.
bool choose_inliers(const std::vector<Observation>& all, Fit& fit)
{
    std::vector<double> rest;
    for (const Observation& o : all) {
        rest.push_back(std::abs(o.off_px - fit.at(o)));
    }
    // The deviation of those that are near; wrong matches lie anywhere.
    std::vector<double> near;
    std::copy_if(rest.begin(), rest.end(), std::back_inserter(near),
                 [](double r) { return r < 2 * kClusterPx; });
    double gate = kLeastGatePx;
    if (!near.empty()) {
        const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
        std::nth_element(near.begin(), middle, near.end());
        gate = std::max(gate, 3 * 1.4826 * *middle);
    }
    std::vector<bool> inlier(all.size());
    double squares = 0;
    fit.inliers = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        inlier[i] = rest[i] <= gate;
        fit.inliers += inlier[i];
        squares += inlier[i] ? rest[i] * rest[i] : 0;
    }
    fit.rms_px = fit.inliers > 0 ? std::sqrt(squares / fit.inliers) : 0;
    const bool changed = inlier != fit.inlier;
    fit.inlier = std::move(inlier);
    return changed;
}

/// Least squares on the inliers; coordinates are centred and scaled for the sake of numbers.
void solve(const std::vector<Observation>& all, bool affine, tiling::Size image, Fit& fit)
{
    const double x0 = image.cols / 2.0;
    const double y0 = image.rows / 2.0;
    const double scale = 2.0 / std::max(image.rows, image.cols);
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (fit.inlier[i]) {
            const Eigen::Vector3d row(1, affine ? (all[i].x - x0) * scale : 0,
                                      affine ? (all[i].y - y0) * scale : 0);
            normal += row * row.transpose();
            right_side += row * all[i].off_px;
        }
    }
    if (!affine) {
        normal(1, 1) = normal(2, 2) = 1;
    }
    const Eigen::Vector3d s = normal.ldlt().solve(right_side);
    fit.abc = {s[0] - (s[1] * x0 + s[2] * y0) * scale, s[1] * scale, s[2] * scale};
}

Fit robust_fit(const std::vector<Observation>& all, bool affine, tiling::Size image, Fit start)
{
    start.inlier.clear();
    for (int round = 0; round < kMaxRounds && choose_inliers(all, start); ++round) {
        if (start.inliers >= 3) {
            solve(all, affine, image, start);
        }
    }
    return start;
}

/// The inliers cover enough of the image to tell how the correction changes across it, and it
/// does not run away in the corners.
bool supported(const std::vector<Observation>& all, const Fit& fit, tiling::Size image)
{
    double x_min = image.cols;
    double x_max = 0;
    double y_min = image.rows;
    double y_max = 0;
    double least = 1e9;
    double most = -1e9;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (fit.inlier[i]) {
            x_min = std::min(x_min, all[i].x);
            x_max = std::max(x_max, all[i].x);
            y_min = std::min(y_min, all[i].y);
            y_max = std::max(y_max, all[i].y);
        }
    }
    for (const double x : {0.0, static_cast<double>(image.cols)}) {
        for (const double y : {0.0, static_cast<double>(image.rows)}) {
            least = std::min(least, fit.at({x, y, 0}));
            most = std::max(most, fit.at({x, y, 0}));
        }
    }
    return x_max - x_min > kAffineSpread * image.cols &&
           y_max - y_min > kAffineSpread * image.rows && most - least < kAffineMostPx;
}

void judge(Pointing& pointing)
{
    const std::string agree =
        fmt::format("{} of {} tie points agree", pointing.inliers, pointing.points);
    if (pointing.inliers < kLeastInliers) {
        throw GeometryError(fmt::format("the pointing of the right image cannot be found: only "
                                        "{}, at least {} must; is it the same place in both "
                                        "images?",
                                        agree, kLeastInliers));
    }
    if (pointing.rms_after_px > kMostRms) {
        throw GeometryError(
            fmt::format("the pointing of the right image cannot be trusted: {}, "
                        "but only to {:.2f} px rms",
                        agree, pointing.rms_after_px));
    }
    if (pointing.inliers < kFewInliers) {
        pointing.warnings.push_back("only " + agree);
    }
    if (pointing.rms_after_px > kHighRms) {
        pointing.warnings.push_back(
            fmt::format("tie points agree only to {:.2f} px rms", pointing.rms_after_px));
    }
}

} // namespace

Pointing estimate_pointing(const EpipolarFrame& frame, std::span<const TiePoint> points,
                           tiling::Size right_size, PointingModel model,
                           std::vector<bool>* inlier)
{
    Pointing pointing;
    pointing.points = static_cast<int>(points.size());
    pointing.across =
        across_line(frame, {(frame.size.rows - 1) / 2.0, (frame.size.cols - 1) / 2.0});
    const auto all = observe(frame, points, pointing.across);
    Fit start;
    start.abc[0] = densest(all);
    Fit fit = robust_fit(all, false, right_size, start);
    if (model != PointingModel::shift && fit.inliers >= kFewInliers) {
        const Fit affine = robust_fit(all, true, right_size, fit);
        const bool better = affine.rms_px < kAffineGain * fit.rms_px ||
                            affine.inliers * kAffineGain > fit.inliers;
        if (supported(all, affine, right_size) && (better || model == PointingModel::affine)) {
            fit = affine;
            pointing.affine = true;
        }
    }
    double squares = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (fit.inlier[i]) {
            squares += all[i].off_px * all[i].off_px;
            pointing.shift_px += fit.at(all[i]);
        }
    }
    pointing.inliers = fit.inliers;
    if (fit.inliers > 0) {
        pointing.rms_before_px = std::sqrt(squares / fit.inliers);
        pointing.shift_px /= fit.inliers;
    }
    pointing.rms_after_px = fit.rms_px;
    pointing.correction = {fit.abc[0] * pointing.across.x, fit.abc[1] * pointing.across.x,
                           fit.abc[2] * pointing.across.x, fit.abc[0] * pointing.across.y,
                           fit.abc[1] * pointing.across.y, fit.abc[2] * pointing.across.y};
    if (inlier != nullptr) {
        *inlier = fit.inlier;
    }
    judge(pointing);
    return pointing;
}

ImageCorrection joined(const ImageCorrection& a, const ImageCorrection& b)
{
    // x + a(x) + b(x + a(x)), with both affine.
    ImageCorrection c;
    const double xx = 1 + b.x_by_x;
    const double yy = 1 + b.y_by_y;
    c.x_px = xx * a.x_px + b.x_by_y * a.y_px + b.x_px;
    c.x_by_x = xx * (1 + a.x_by_x) + b.x_by_y * a.y_by_x - 1;
    c.x_by_y = xx * a.x_by_y + b.x_by_y * (1 + a.y_by_y);
    c.y_px = b.y_by_x * a.x_px + yy * a.y_px + b.y_px;
    c.y_by_x = b.y_by_x * (1 + a.x_by_x) + yy * a.y_by_x;
    c.y_by_y = b.y_by_x * a.x_by_y + yy * (1 + a.y_by_y) - 1;
    return c;
}

Pointing joined(const Pointing& rough, const Pointing& then)
{
    Pointing both = then;
    both.correction = joined(rough.correction, then.correction);
    both.shift_px += rough.shift_px;
    // The mean of the squares is the square of the mean and what lies round it.
    const double spread =
        then.rms_before_px * then.rms_before_px - then.shift_px * then.shift_px;
    both.rms_before_px = std::sqrt(std::max(spread, 0.0) + both.shift_px * both.shift_px);
    return both;
}

} // namespace hsgm::geometry
