#pragma once

#include "pipeline/stages/scene_cameras.h"
#include "pipeline/synth/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace hsgm::pipeline {

struct SceneConfig {
    synth::Scene scene;
    std::optional<SceneCameras> cameras; ///< where the scene is one seen from orbit
    std::string used_yaml; ///< the complete scene, defaults included; reads back as the same
};

/// Reads a scene from a YAML file; what it leaves out keeps its default, and `city` and
/// `cameras` stand only where the file has that section. `overrides` are "key=value" as of
/// `--set`, for example "size=[200, 300]" or "terrain.offset_px=5". Throws io::ConfigError for
/// unknown keys, values of a wrong kind, and scenes that are not valid.
SceneConfig read_scene(const std::string& path, const std::vector<std::string>& overrides = {});

} // namespace hsgm::pipeline
