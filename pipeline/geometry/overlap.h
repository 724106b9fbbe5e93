#pragma once

#include "pipeline/geometry/ground_camera.h"
#include "tiling/rect.h"

namespace hsgm::geometry {

/// Heights above the ellipsoid, lowest and highest.
struct HeightSpan {
    double low_m = 0;
    double high_m = 0;
};

/// What two images share at different heights of the ground.
struct Overlap {
    double level_m = 0; ///< in the middle of the heights at which they share most
    double area_m2 = 0; ///< the largest area that they share
    HeightSpan shared;  ///< heights at which they share more than a tenth of that
};

/// Looks at 65 heights of the span. Parts cut from scenes share little or nothing at a wrong
/// height, so the best one is a first guess of the right one; whole scenes share all the same
/// at every height. Throws GeometryError where the images share nothing at any height, with
/// where each lies in the middle of the span.
Overlap find_overlap(const GroundCamera& left, tiling::Size left_size,
                     const GroundCamera& right, tiling::Size right_size, HeightSpan heights);

/// The heights that a model says it is for, or what both have in common of them; within what
/// there is on Earth (-500 to 9000 m). Throws GeometryError where they have nothing in common.
HeightSpan heights_of(const RpcModel& left, const RpcModel& right);

} // namespace hsgm::geometry
