#pragma once

#include "pipeline/geometry/ground_camera.h"
#include "pipeline/geometry/reference_surface.h"
#include "tiling/rect.h"

#include <optional>
#include <vector>

namespace hsgm::geometry {

/// Corners of a convex region of a map, anticlockwise seen from above; empty: no region.
using Polygon = std::vector<MapPoint>;

/// The common part of two convex polygons (Sutherland and Hodgman); empty where they are
/// apart. Heights are left 0.
Polygon intersection(const Polygon& a, const Polygon& b);

/// Of a convex polygon, in square metres.
double area_m2(const Polygon& polygon);

/// The place at which the ray of an image point meets the surface lifted by `above_m`; nothing
/// where it does not.
std::optional<MapPoint> meet_surface(const GroundCamera& camera, ImagePoint image,
                                     const ReferenceSurface& surface, double above_m = 0);

/// What an image shows of the surface lifted by some metres: the quadrangle of the centres of
/// its corner pixels. Its sides are straight, those of the image's true outline are not.
struct Footprint {
    Polygon corners;
    double bulge_m = 0; ///< how far the middles of the true sides lie off the straight ones
};

/// Throws GeometryError where a corner of the image meets no ground.
Footprint footprint(const GroundCamera& camera, tiling::Size image,
                    const ReferenceSurface& surface, double above_m = 0);

} // namespace hsgm::geometry
