#pragma once

#include "pipeline/geometry/elevation_grid.h"
#include "pipeline/geometry/map_projection.h"
#include "pipeline/geometry/reference_surface.h"

namespace hsgm::geometry {

/// A rectangle of a map.
struct MapBox {
    double west = 0;
    double south = 0;
    double east = 0;
    double north = 0;

    /// The least box with this one and that place.
    void include(double x, double y);
    double width() const { return east - west; }
    double height() const { return north - south; }
    MapBox grown(double by) const { return {west - by, south - by, east + by, north + by}; }
    /// Holds no place until one is included.
    static MapBox nothing();
    bool empty() const { return !(west <= east && south <= north); }
};

/// The smooth surface of a reference DEM, and how much of it the DEM knew.
struct ReliefSurface {
    ReferenceSurface surface;
    double covered = 0; ///< share of the posts inside the box that have a height, 0..1
    double lowest_m = 0;
    double highest_m = 0;
    /// Of the DEM over the surface, which is smoother: lowest (0 or less) and highest.
    double dem_below_m = 0;
    double dem_above_m = 0;
};

/// Draws a surface through posts `step_m` apart on `map`, over a box and two steps round it. A
/// post is the mean of the DEM's heights in its cell, so that what is smaller than a cell is
/// not taken out of the images. Posts that the DEM does not know take the mean of their nearest
/// known neighbours: the surface only says where disparities count from. Throws GeometryError
/// where not a single post inside the box has a height.
ReliefSurface relief_surface(const ElevationGrid& dem, const MapProjection& map,
                             const MapBox& box, double step_m);

} // namespace hsgm::geometry
