#pragma once

#include "io/config.h"

#include <array>
#include <optional>
#include <string>

namespace hsgm::pipeline {

/// The part of the ground that is wanted. Both absent: everything.
struct RegionOptions {
    std::optional<std::array<double, 4>> bounds; ///< west, south, east, north
    std::string bounds_crs; ///< as PROJ knows it; empty: the map of the DSM
    std::string file;       ///< or a vector file whose polygons bound it

    bool empty() const { return !bounds && file.empty(); }
};

/// Reads `bounds`, `bounds_crs` and `region`. Throws ConfigError for bounds that are no
/// rectangle, an unknown reference system, and keys that contradict each other.
RegionOptions read_region(io::ConfigSection& section);

} // namespace hsgm::pipeline
