#include "pipeline/geometry/tie_points.h"

#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hsgm::geometry {

namespace {

constexpr double kRatio = 0.8;      // of the best to the second best distance
constexpr int kNearNothingPx = 9;   // features so close to pixels without value are not used
constexpr double kContrast = 0.015; // SIFT's least contrast: satellite images are flat
constexpr int kLeastSide = 32;

/// OpenCV works on the calling thread while this lives: threads belong to the pipeline, and
/// one thread makes one order.
class OneThread {
public:
    OneThread() : before_(cv::getNumThreads()) { cv::setNumThreads(1); }
    ~OneThread() { cv::setNumThreads(before_); }
    OneThread(const OneThread&) = delete;
    OneThread& operator=(const OneThread&) = delete;

private:
    int before_;
};

struct Grey {
    cv::Mat pixels; // 8 bits, between the 0.5 and 99.5 percentiles
    cv::Mat usable; // 0 near pixels without a value
};

Grey to_grey(const FramePatch& patch)
{
    const auto& values = patch.pixels;
    std::vector<double> valid;
    for (int r = 0; r < values.rows(); ++r) {
        for (const double value : values.row_span(r)) {
            if (!std::isnan(value)) {
                valid.push_back(value);
            }
        }
    }
    Grey grey{cv::Mat(values.rows(), values.cols(), CV_8U, cv::Scalar(0)),
              cv::Mat(values.rows(), values.cols(), CV_8U, cv::Scalar(0))};
    if (valid.empty()) {
        return grey;
    }
    const auto percentile = [&valid](double share) {
        const auto at = valid.begin() + static_cast<std::ptrdiff_t>(
                                            share * static_cast<double>(valid.size() - 1));
        std::nth_element(valid.begin(), at, valid.end());
        return *at;
    };
    const double low = percentile(0.005);
    const double high = std::max(percentile(0.995), low + 1e-9);
    for (int r = 0; r < values.rows(); ++r) {
        for (int c = 0; c < values.cols(); ++c) {
            const double value = values(r, c);
            if (!std::isnan(value)) {
                const double scaled = (value - low) / (high - low) * 255;
                grey.pixels.at<unsigned char>(r, c) =
                    static_cast<unsigned char>(std::clamp(scaled, 0.0, 255.0) + 0.5);
                grey.usable.at<unsigned char>(r, c) = 255;
            }
        }
    }
    const cv::Mat element = cv::getStructuringElement(
        cv::MORPH_RECT, {2 * kNearNothingPx + 1, 2 * kNearNothingPx + 1});
    cv::erode(grey.usable, grey.usable, element, {-1, -1}, 1, cv::BORDER_CONSTANT,
              cv::Scalar(0));
    return grey;
}

struct Features {
    std::vector<FramePoint> places;
    cv::Mat descriptors;
};

Features features_of(const FramePatch& patch, int count)
{
    Features features;
    if (patch.pixels.rows() < kLeastSide || patch.pixels.cols() < kLeastSide) {
        return features;
    }
    const Grey grey = to_grey(patch);
    std::vector<cv::KeyPoint> points;
    cv::SIFT::create(count, 3, kContrast)
        ->detectAndCompute(grey.pixels, grey.usable, points, features.descriptors);
    for (const cv::KeyPoint& point : points) {
        features.places.push_back(
            {patch.row + double{point.pt.y}, patch.col + double{point.pt.x}});
    }
    return features;
}

/// 255 where the pair of features is within the gate.
cv::Mat gate_mask(const Features& left, const Features& right, const TieGate& gate)
{
    cv::Mat mask(static_cast<int>(left.places.size()), static_cast<int>(right.places.size()),
                 CV_8U);
    for (int i = 0; i < mask.rows; ++i) {
        for (int j = 0; j < mask.cols; ++j) {
            const TiePoint pair{left.places[std::size_t(i)], right.places[std::size_t(j)]};
            const bool in = pair.disparity_px() >= gate.disparity_min_px &&
                            pair.disparity_px() <= gate.disparity_max_px &&
                            std::abs(pair.row_parallax_px() - gate.row_parallax_px) <=
                                gate.row_tolerance_px;
            mask.at<unsigned char>(i, j) = in ? 255 : 0;
        }
    }
    return mask;
}

/// For each feature of `from` the clear winner among those of `to`, or -1.
std::vector<int> winners(const Features& from, const Features& to, const cv::Mat& mask)
{
    std::vector<std::vector<cv::DMatch>> best;
    cv::BFMatcher(cv::NORM_L2).knnMatch(from.descriptors, to.descriptors, best, 2, mask);
    std::vector<int> winner(from.places.size(), -1);
    for (const auto& candidates : best) {
        if (!candidates.empty() &&
            (candidates.size() == 1 ||
             candidates[0].distance < kRatio * double{candidates[1].distance})) {
            winner[std::size_t(candidates[0].queryIdx)] = candidates[0].trainIdx;
        }
    }
    return winner;
}

} // namespace

std::vector<TiePoint> match_features(const FramePatch& left, const FramePatch& right,
                                     const TieGate& gate, int count)
{
    const OneThread one_thread;
    const Features a = features_of(left, count);
    const Features b = features_of(right, count);
    std::vector<TiePoint> points;
    if (a.places.empty() || b.places.empty()) {
        return points;
    }
    const cv::Mat mask = gate_mask(a, b, gate);
    const auto forward = winners(a, b, mask);
    const auto backward = winners(b, a, mask.t());
    for (std::size_t i = 0; i < forward.size(); ++i) {
        if (forward[i] >= 0 && backward[std::size_t(forward[i])] == static_cast<int>(i)) {
            points.push_back({a.places[i], b.places[std::size_t(forward[i])]});
        }
    }
    std::sort(points.begin(), points.end(), [](const TiePoint& p, const TiePoint& q) {
        return p.left.row != q.left.row ? p.left.row < q.left.row : p.left.col < q.left.col;
    });
    // A feature with two orientations may match twice at the same place.
    points.erase(std::unique(points.begin(), points.end(),
                             [](const TiePoint& p, const TiePoint& q) {
                                 return p.left.row == q.left.row && p.left.col == q.left.col;
                             }),
                 points.end());
    return points;
}

} // namespace hsgm::geometry
