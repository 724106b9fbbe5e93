#pragma once

#include "pipeline/stages/pixel_source.h"
#include "tiling/image.h"

namespace hsgm::pipeline {

/// An image whose pixels are the means of `factor` x `factor` pixels of a source (fewer at its
/// right and lower edges): those of them with a value, if at least half have one; else NaN.
/// Streams the source through once.
tiling::Image<double> reduced_image(PixelSource& source, int factor);

} // namespace hsgm::pipeline
