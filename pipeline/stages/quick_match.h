#pragma once

#include "tiling/disparity_range.h"
#include "tiling/image.h"

namespace hsgm::pipeline {

/// Matches two small resampled images in memory, with the matcher's defaults: disparities of
/// the left one that the left-right check leaves and whose confidence is at least that given
/// (1 to 255), in pixels; NaN elsewhere. The images (NaN: no value) have equal heights. For
/// finding what a pair is like before it is matched; memory of some 60 bytes a pixel beside
/// that of the coarsest level.
tiling::Image<float> quick_match(const tiling::Image<double>& left,
                                 const tiling::Image<double>& right,
                                 tiling::DisparityRange disparity, int least_confidence);

} // namespace hsgm::pipeline
