#pragma once

#include "pipeline/stages/geometry_search.h"

namespace hsgm::pipeline {

/// Heights at which the ground may lie: those given; or round the DEM's; or round the plane
/// that orthoimages were made on; or those that the RPCs are for. Throws GeometryError where
/// RPCs have none in common.
geometry::HeightSpan possible_heights(const geometry::SensorModel& left,
                                      const geometry::SensorModel& right,
                                      const PairGeometryOptions& options);

/// Heights within which ground is looked for, as if the surface were level at its mean.
geometry::HeightSpan heights_round(const geometry::ReliefSurface& relief,
                                   const PairGeometryOptions& options);

/// The ground in the middle of an image, halfway between the heights; nothing where a model
/// does not reach it.
std::optional<geometry::GeodeticPoint>
middle_of(const geometry::SensorModel& model, tiling::Size size, geometry::HeightSpan heights);

/// The surface along which a pair's frame is laid: the DEM over the box (in degrees), smoothed
/// so far that the frame's lattices need no more nodes than they can have. `pixel_m` is about
/// the images' ground sampling distance, `least_cell_m` how smooth it must be at least.
geometry::ReliefSurface relief_of(const geometry::ElevationGrid& dem,
                                  const geometry::MapProjection& map,
                                  const geometry::MapBox& degrees, double pixel_m,
                                  double least_cell_m);

/// About the ground sampling distance of an image.
double pixel_of(const geometry::GroundCamera& camera, tiling::Size size,
                geometry::HeightSpan heights);

} // namespace hsgm::pipeline
