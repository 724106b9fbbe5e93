#pragma once

#include "pipeline/geometry/tie_points.h"
#include "tiling/image.h"

#include <optional>
#include <span>

namespace hsgm::geometry {

/// Disparities, lowest and highest, in pixels.
struct DisparityBounds {
    double min_px = 0;
    double max_px = 0;
    /// The widest gap between values of the lowest quarter, and of the highest: ground has
    /// hardly any, what clouds and repeated patterns match at has.
    double low_gap_px = 0;
    double high_gap_px = 0;
};

/// What the bulk of the tie points spans: all but the 2 % lowest and highest, so that a few
/// wrong ones move nothing. Nothing for less than 20 points.
std::optional<DisparityBounds> bounds_of(std::span<const TiePoint> points);

/// What a disparity map (NaN: no value) spans where it can be believed: values that at least
/// five of their eight neighbours agree with to a pixel; of these, all but the lowest and
/// highest half per mille. Nothing where less than 200 pixels can be believed.
std::optional<DisparityBounds> bounds_of(tiling::ImageView<const float> disparity_px);

} // namespace hsgm::geometry
