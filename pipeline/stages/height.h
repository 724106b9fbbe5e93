#pragma once

#include "pipeline/job.h"
#include "tiling/image.h"

namespace hsgm::pipeline {

/// reference_height_m + disparity * height_per_px_m, in metres; nodata stays nodata.
tiling::Image<float> heights(const tiling::Image<float>& disparity_px,
                             const RectifiedGeometry& geometry);

/// focal_px * baseline_m / disparity, in metres; nodata where the disparity is nodata or not
/// above 0 (a point at or beyond infinity).
tiling::Image<float> depths(const tiling::Image<float>& disparity_px,
                            const RectifiedGeometry& geometry);

} // namespace hsgm::pipeline
