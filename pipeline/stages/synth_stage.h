#pragma once

#include "pipeline/synth/scene.h"
#include "pipeline/synth/terrain.h"

#include <string>

namespace hsgm::pipeline {

/// Renders a scene into a folder, which is made where it is missing:
///
///   left.tif, right.tif              uint8 for scenes of 8 bits, else uint16; nodata 0
///   truth_left.tif, truth_right.tif  float32, disparity x_left - x_right in pixels
///   visible_left.tif                 uint8: 255 = shows in both images
///
/// Strip by strip, on all threads that TBB lends; memory for a few hundred rows. The files
/// do not depend on the number of threads. Returns the bounds of the disparity, which a
/// matcher needs to know. Throws io::ConfigError for a scene that is not valid, and
/// io::StorageError where the folder cannot be written.
synth::DisparityBounds write_scene(const synth::Scene& scene, const std::string& folder);

} // namespace hsgm::pipeline
