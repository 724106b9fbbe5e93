#pragma once

#include "pipeline/synth/scene.h"

#include <string>
#include <vector>

namespace hsgm::pipeline {

/// Reads a scene from a YAML file; what it leaves out keeps its default. `overrides` are
/// "key=value" as of `--set`, for example "size=[200, 300]" or "terrain.offset_px=5". Throws
/// io::ConfigError for unknown keys, values of a wrong type, and scenes that are not valid.
synth::Scene read_scene(const std::string& path, const std::vector<std::string>& overrides);

/// The complete scene as YAML that read_scene understands: every number in full.
std::string scene_as_yaml(const synth::Scene& scene);

} // namespace hsgm::pipeline
