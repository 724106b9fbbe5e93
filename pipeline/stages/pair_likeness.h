#pragma once

#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/geometry/pair_geometry.h"
#include "pipeline/stages/sensor_view.h"
#include "tiling/disparity_range.h"
#include "tiling/image.h"

namespace hsgm::pipeline {

/// How alike both images of a pair are: patches spread over the frame are matched, and windows
/// of the left image correlated with what they were matched to. `right_view` has its
/// correction.
geometry::Likeness measure_likeness(const SensorView& left_view, const SensorView& right_view,
                                    const geometry::EpipolarFrame& frame,
                                    tiling::DisparityRange disparity);

/// Adds the windows of one patch: `disparity` (NaN: none) counts from a pixel of `left` to the
/// pixel of `right` so many columns to its left, where it is not beyond.
void add_windows(const tiling::Image<double>& left, const tiling::Image<double>& right,
                 const tiling::Image<float>& disparity, geometry::Likeness& likeness);

} // namespace hsgm::pipeline
