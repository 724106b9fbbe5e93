#pragma once

#include "pipeline/geometry/elevation_grid.h"
#include "pipeline/geometry/relief_surface.h"

#include <memory>
#include <string>

namespace hsgm::pipeline {

/// A reference DEM as a configuration states it.
struct ElevationSpec {
    std::string path;
    /// What its heights count from: "ellipsoid", "EGM96", "EPSG:5773" and the like. Empty: what
    /// the file says, or the ellipsoid where it says nothing.
    std::string vertical;

    bool operator==(const ElevationSpec&) const = default;
};

struct Elevation {
    std::shared_ptr<const geometry::ElevationGrid> grid;
    std::string warning; ///< where something had to be taken for granted; or empty
};

/// Reads the part of a DEM that covers a box of longitudes and latitudes (degrees, as x and y),
/// with its heights turned into those above the WGS84 ellipsoid. Pixels are posts at their
/// centres. Throws InputError where the file cannot be read, lies on no map, has no height
/// inside the box, or too many posts for memory there (more than 64 Mi); ConfigError where its
/// vertical datum cannot be reached, naming the grid that is missing.
Elevation read_elevation(const ElevationSpec& spec, const geometry::MapBox& degrees);

/// What a vertical datum must be, tried on any map; throws std::invalid_argument.
void check_vertical(const std::string& vertical);

} // namespace hsgm::pipeline
