#pragma once

#include "pipeline/stages/scene_cameras.h"
#include "pipeline/synth/scene.h"

#include <string>

namespace hsgm::pipeline {

struct OrbitSceneSummary {
    tiling::Size left; ///< of the images
    tiling::Size right;
    double lowest_m = 0; ///< above the ellipsoid
    double highest_m = 0;
};

/// Renders a scene as two cameras on orbit take it, into a folder that is made where it is
/// missing:
///
///   left.tif, right.tif  uint8 for scenes of 8 bits, else uint16; nodata 0; with RPCs
///   truth_dsm.tif        float32, height above the WGS84 ellipsoid at the map cells' centres
///   truth_classes.tif    uint8: 0 ground, 1 object, 4 ground of low texture
///   truth_visible.tif    uint8: bit 0 seen in left, bit 1 in right
///
/// and, where the cameras say so, orthoimages (synth_ortho_stage.h).
///
/// Strip by strip, on all threads that TBB lends; the files do not depend on their number.
/// Throws io::ConfigError for a scene that is not valid, io::StorageError where the folder
/// cannot be written.
OrbitSceneSummary write_orbit_scene(const synth::Scene& scene, const SceneCameras& cameras,
                                    const std::string& folder);

} // namespace hsgm::pipeline
