#include "pipeline/stages/patch_ties.h"

#include "pipeline/stages/frame_patches.h"
#include "pipeline/stages/resampled_source.h"
#include "tiling/disparity_range.h"
#include "tiling/image.h"

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
    std::vector<TiePoint> points;
    for (const Rect& here : spread_patches(frame.size, kPatchPx, kPatchesAcross)) {
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
