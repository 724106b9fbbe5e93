#pragma once

#include "pipeline/stages/scene_cameras.h"
#include "pipeline/synth/overhead_renderer.h"
#include "pipeline/synth/scene.h"

#include <string>

namespace hsgm::pipeline {

/// Renders the orthoimages of a scene whose cameras have `ortho`, on the grid of its map:
///
///   ortho_left.tif, ortho_right.tif  as left.tif and right.tif are stored; how they were taken
///                                    is in their metadata (VIEW_AZIMUTH_DEG,
///                                    VIEW_INCIDENCE_DEG)
///   reference_dem.tif                float32, bare ground with errors, heights above the WGS84
///                                    ellipsoid: what they were made on, unless on a plane
///
/// Between posts, which lie at the corners of cells, the DEM is bilinear.
void write_orthos(const synth::Scene& scene, const SceneCameras& cameras,
                  const synth::OverheadRenderer& renderer, const std::string& folder);

} // namespace hsgm::pipeline
