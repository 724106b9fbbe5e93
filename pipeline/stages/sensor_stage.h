#pragma once

#include "io/image_spec.h"
#include "io/raster_source.h"
#include "pipeline/geometry/elevation_grid.h"
#include "pipeline/geometry/relief_surface.h"
#include "pipeline/geometry/relief_warp.h"
#include "pipeline/geometry/sensor_model.h"

#include <memory>
#include <optional>

namespace hsgm::pipeline {

/// What the orthoimages of a pair were made on: a plane, else the DEM.
struct OrthoBase {
    std::optional<double> plane_m; ///< height above the ellipsoid
    std::shared_ptr<const geometry::ElevationGrid> dem;
};

/// The model of an orthoimage: its map, and how it was taken, from (the first there is) the
/// specification's vector or angles, the RPC that it names (any file of an RPC, or a raster
/// that has one), that in the image itself, or angles in its metadata (`view_in`). Throws
/// InputError where it lies on no map or nothing says how it was taken, ConfigError for a map
/// that PROJ cannot reach.
geometry::OrthoModel open_ortho(const io::RasterSource& image, const io::ImageSpec& spec,
                                const OrthoBase& base);

/// Azimuth and incidence in degrees from an image's metadata: VIEW_AZIMUTH_DEG and
/// VIEW_INCIDENCE_DEG, or meanSatAz and meanSatEl of an .IMD file; nothing where there are
/// none.
std::optional<std::array<double, 2>> view_in(const io::RasterSource& image);

/// Where an orthoimage lies, in degrees (x longitude, y latitude).
geometry::MapBox lonlat_box(const geometry::OrthoModel& model);
/// What a raw image shows of the ground between two heights; empty where it shows none.
geometry::MapBox lonlat_box(const geometry::RpcModel& model, tiling::Size size, double low_m,
                            double high_m);

/// Whether two models are of one image taken one way, but for the last digits, which may differ
/// between machines.
bool same_sensor(const geometry::SensorModel& a, const geometry::SensorModel& b);

/// The way from a model's pixels to those of the file; null where they are the same.
std::shared_ptr<const geometry::ReliefWarp> warp_of(const geometry::SensorModel& model,
                                                    const OrthoBase& base);

} // namespace hsgm::pipeline
