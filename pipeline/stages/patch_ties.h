#pragma once

#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/geometry/tie_points.h"
#include "pipeline/stages/sensor_view.h"

#include <vector>

namespace hsgm::pipeline {

/// Features of patches at full resolution, evenly spread over the frame, whose partners lie at
/// the frame's heights and within `row_tolerance_px` of their rows.
std::vector<geometry::TiePoint> patch_points(const SensorView& left_view,
                                             const SensorView& right_view,
                                             const geometry::EpipolarFrame& frame,
                                             double row_tolerance_px);

} // namespace hsgm::pipeline
