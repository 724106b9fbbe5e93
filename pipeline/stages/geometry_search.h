#pragma once

#include "io/image_spec.h"
#include "pipeline/geometry/overlap.h"
#include "pipeline/geometry/pair_geometry.h"
#include "pipeline/geometry/pointing.h"
#include "pipeline/geometry/rpc_camera.h"
#include "pipeline/region.h"
#include "pipeline/stages/elevation_stage.h"
#include "pipeline/stages/sensor_stage.h"

#include <optional>
#include <string>

namespace hsgm::pipeline {

/// A raw image with its model.
struct SensorImage {
    io::ImageSpec image; ///< with the model's file, where it is not the image's own
    /// What is known to be added to the model's image points, from an earlier run.
    geometry::ImageCorrection correction;
};

/// What a pair's geometry is found with. Heights are above the WGS84 ellipsoid.
struct PairGeometryOptions {
    /// Lowest and highest ground; absent: found from the images.
    std::optional<geometry::HeightSpan> heights;
    /// Given: the images are orthoimages, made on this.
    std::optional<OrthoBase> ortho;
    /// The ground as it is known: the frame is laid along it, and heights are looked for near
    /// it. Null: the frame is level.
    std::shared_ptr<const geometry::ElevationGrid> dem;
    /// Lowest and highest ground over the DEM; absent: found from the images.
    std::optional<geometry::HeightSpan> above_dem;
    /// How the right image's pointing is mended; absent: it is taken as it is.
    std::optional<geometry::PointingModel> pointing = geometry::PointingModel::automatic;
    double largest_pointing_px = 50; ///< how far off it may be
    double gsd_m = 0;                ///< of the frame; 0: three quarters of the images'
    RegionOptions region;            ///< the ground that the frame must hold
    std::string crs;                 ///< of the ground points; empty: the UTM zone
    std::string vertical;            ///< datum of their heights; empty: the ellipsoid
    bool likeness = false;           ///< measure how alike the images are: penalties fit that
};

/// The model of an image as these options take it.
geometry::SensorModel open_sensor(const io::RasterSource& source, const io::ImageSpec& image,
                                  const PairGeometryOptions& options);

/// What both images may show, in degrees, with some room round it: where a DEM is asked for.
/// Throws InputError where they have nothing in common.
geometry::MapBox ground_box(const SensorImage& left, const SensorImage& right,
                            const PairGeometryOptions& options);

/// Finds a pair's geometry from its images:
///
///     models, overlap -> reduced images, coarse frame -> features -> rough pointing, heights
///        -> reduced images matched -> range of heights -> frame -> features of patches at
///        full resolution -> pointing -> final frame, range and ground lattice -> likeness
///
/// Pointing and heights are those of all that both images show; a region of interest limits the
/// frame alone. Reads each image through once and patches of it again; memory does not grow
/// with them. Throws InputError in a sentence that names the images
/// where they make no pair, and ConfigError for a map that cannot be used.
geometry::PairGeometry find_pair_geometry(const SensorImage& left, const SensorImage& right,
                                          const PairGeometryOptions& options);

} // namespace hsgm::pipeline
