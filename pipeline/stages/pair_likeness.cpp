#include "pipeline/stages/pair_likeness.h"

#include "pipeline/stages/frame_patches.h"
#include "pipeline/stages/quick_match.h"

#include <cmath>
#include <limits>

namespace hsgm::pipeline {

namespace {

using geometry::Likeness;
using tiling::Image;
using tiling::Rect;

constexpr int kPatchPx = 256;
constexpr int kPatchesAcross = 4;

constexpr int kWindowPx = 7;
constexpr int kWindowStepPx = 3;
/// Windows that correlate by less hold much noise and change beside their texture: matching
/// them takes neighbours that agree. How many there are tells which pairs gain from large
/// penalties (docs/geometry.md).
constexpr double kAlike = 0.8;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// What the right image has for the pixels of the left one, between its columns linearly.
Image<double> moved(const Image<double>& right, const Image<float>& disparity)
{
    Image<double> result(disparity.size(), kNone);
    for (int row = 0; row < disparity.rows(); ++row) {
        for (int col = 0; col < disparity.cols(); ++col) {
            const double x = col - double{disparity(row, col)};
            if (x >= 0 && x <= right.cols() - 2) { // not so if NaN
                const int before = static_cast<int>(x);
                const double part = x - before;
                result(row, col) =
                    right(row, before) * (1 - part) + right(row, before + 1) * part;
            }
        }
    }
    return result;
}

/// Of the window that begins at (row, col); NaN where a pixel of it has no value, 0 where
/// either image is flat there.
double correlation(const Image<double>& a, const Image<double>& b, int row, int col)
{
    constexpr int kPixels = kWindowPx * kWindowPx;
    double sum_a = 0;
    double sum_b = 0;
    double sum_aa = 0;
    double sum_bb = 0;
    double sum_ab = 0;
    for (int r = row; r < row + kWindowPx; ++r) {
        for (int c = col; c < col + kWindowPx; ++c) {
            sum_a += a(r, c);
            sum_b += b(r, c);
            sum_aa += a(r, c) * a(r, c);
            sum_bb += b(r, c) * b(r, c);
            sum_ab += a(r, c) * b(r, c);
        }
    }
    const double square =
        (kPixels * sum_aa - sum_a * sum_a) * (kPixels * sum_bb - sum_b * sum_b);
    if (std::isnan(square)) {
        return kNone;
    }
    return square > 0 ? (kPixels * sum_ab - sum_a * sum_b) / std::sqrt(square) : 0;
}

} // namespace

void add_windows(const Image<double>& left, const Image<double>& right,
                 const Image<float>& disparity, Likeness& likeness)
{
    const Image<double> partner = moved(right, disparity);
    for (int row = 0; row + kWindowPx <= left.rows(); row += kWindowStepPx) {
        for (int col = 0; col + kWindowPx <= left.cols(); col += kWindowStepPx) {
            const double found = correlation(left, partner, row, col);
            if (!std::isnan(found)) {
                ++likeness.windows;
                likeness.unlike += found < kAlike ? 1 : 0;
            }
        }
    }
}

Likeness measure_likeness(const SensorView& left_view, const SensorView& right_view,
                          const geometry::EpipolarFrame& frame,
                          tiling::DisparityRange disparity)
{
    ResampledSource left = left_view.resampled(frame.left, frame.size);
    ResampledSource right = right_view.resampled(frame.right, frame.size);
    Likeness likeness;
    for (const Rect& here : spread_patches(frame.size, kPatchPx, kPatchesAcross)) {
        const Rect there = intersect(right_reach(here, disparity), rect_of(frame.size));
        if (there.empty()) {
            continue;
        }
        Image<double> a(here.size());
        Image<double> b(there.size());
        left.read(here, a);
        right.read(there, b);
        const int between = there.col - here.col;
        const tiling::DisparityRange inside{disparity.min + between, disparity.max + between};
        add_windows(a, b, quick_match(a, b, inside, 0), likeness);
    }
    return likeness;
}

} // namespace hsgm::pipeline
