#pragma once

#include "io/config.h"
#include "pipeline/satellite_options.h"

#include <string>

namespace hsgm::pipeline {

/// Reads the keys of `geometry` and `dsm` that raw pairs have. Nothing where `kind` is another
/// one: then a key that says something else than its default throws ConfigError.
std::optional<SatelliteOptions> read_satellite(io::ConfigSection geometry,
                                               io::ConfigSection dsm, const std::string& kind);

} // namespace hsgm::pipeline
