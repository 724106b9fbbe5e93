#include "pipeline/stages/patch_ties.h"

#include "pipeline/stages/resampled_source.h"
#include "tiling/disparity_range.h"
#include "tiling/image.h"

#include <algorithm>
#include <cmath>

namespace hsgm::pipeline {

namespace {

using geometry::TieGate;
using geometry::TiePoint;
using tiling::Image;
using tiling::Rect;

/// Patches at full resolution from which the pointing is found.
constexpr int kPatchPx = 512;
constexpr int kPatchesAcross = 4;
constexpr int kPatchFeatures = 2000;

} // namespace

std::vector<TiePoint> patch_points(const SensorView& left_view, const SensorView& right_view,
                                   const geometry::EpipolarFrame& frame,
                                   double row_tolerance_px)
{
    ResampledSource left = left_view.resampled(frame.left, frame.size);
    ResampledSource right = right_view.resampled(frame.right, frame.size);
    const TieGate gate{frame.below_m * frame.px_per_m, frame.above_m * frame.px_per_m, 0,
                       row_tolerance_px};
    const auto patches_of = [](int extent) {
        return std::clamp((extent + kPatchPx / 2) / kPatchPx, 1, kPatchesAcross);
    };
    const int down = patches_of(frame.size.rows);
    const int across = patches_of(frame.size.cols);
    std::vector<TiePoint> points;
    for (int i = 0; i < down * across; ++i) {
        const int row = (2 * (i / across) + 1) * frame.size.rows / (2 * down) - kPatchPx / 2;
        const int col = (2 * (i % across) + 1) * frame.size.cols / (2 * across) - kPatchPx / 2;
        const Rect here = intersect({row, col, kPatchPx, kPatchPx}, rect_of(frame.size));
        const Rect there = intersect(
            expand(right_reach(here, {static_cast<int>(std::floor(gate.disparity_min_px)),
                                      static_cast<int>(std::ceil(gate.disparity_max_px))}),
                   static_cast<int>(gate.row_tolerance_px) + 16),
            rect_of(frame.size));
        Image<double> a(here.size());
        Image<double> b(there.size());
        left.read(here, a);
        right.read(there, b);
        const auto found =
            geometry::match_features({here.row, here.col, a.view()},
                                     {there.row, there.col, b.view()}, gate, kPatchFeatures);
        points.insert(points.end(), found.begin(), found.end());
    }
    return points;
}

} // namespace hsgm::pipeline
