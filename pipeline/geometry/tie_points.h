#pragma once

#include "pipeline/geometry/epipolar_frame.h"
#include "tiling/image.h"

#include <vector>

namespace hsgm::geometry {

/// One thing that both resampled images show: where the left one has it, and the right one.
struct TiePoint {
    FramePoint left;
    FramePoint right;

    double disparity_px() const { return left.col - right.col; }
    double row_parallax_px() const { return left.row - right.row; }
};

/// A part of a resampled image, NaN where it has no value; `row`, `col` of the frame is the
/// part's first pixel.
struct FramePatch {
    int row = 0;
    int col = 0;
    tiling::ImageView<const double> pixels;
};

/// Where the partner of a point may lie.
struct TieGate {
    double disparity_min_px = 0;
    double disparity_max_px = 0;
    double row_parallax_px = 0; ///< expected
    double row_tolerance_px = 0;
};

/// Finds the same features (SIFT: Lowe, IJCV 2004) in both patches: each the other's best
/// within the gate, and clearly better than the second best there. At most `count` features a
/// patch. In the order of the left points, row by row; some are wrong.
std::vector<TiePoint> match_features(const FramePatch& left, const FramePatch& right,
                                     const TieGate& gate, int count = 4000);

} // namespace hsgm::geometry
