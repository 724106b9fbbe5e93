#pragma once

#include "io/image_spec.h"
#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/geometry/ground_lattice.h"
#include "pipeline/geometry/overlap.h"
#include "pipeline/geometry/pointing.h"
#include "pipeline/geometry/reference_surface.h"
#include "pipeline/geometry/rpc_camera.h"
#include "tiling/disparity_range.h"

#include <optional>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// A raw image with its model.
struct SensorImage {
    io::ImageSpec image;
    std::string rpc_file; ///< empty: what the image carries
    /// What is known to be added to the model's image points, from an earlier run.
    geometry::ImageCorrection correction;
};

/// What a pair's geometry is found with. Heights are above the WGS84 ellipsoid.
struct PairGeometryOptions {
    /// Lowest and highest ground; absent: found from the images.
    std::optional<geometry::HeightSpan> heights;
    /// How the right image's pointing is mended; absent: it is taken as it is.
    std::optional<geometry::PointingModel> pointing = geometry::PointingModel::automatic;
    double largest_pointing_px = 50; ///< how far off it may be
    double gsd_m = 0;                ///< of the frame; 0: that of the images
    geometry::Polygon region_deg;    ///< convex: x longitude, y latitude; empty: everything
    std::string crs;                 ///< of the ground points; empty: the UTM zone
    std::string vertical;            ///< datum of their heights; empty: the ellipsoid
};

/// All that is known of a pair before it is matched. Made once, stored, and then only read:
/// whoever has it agrees with all others to the last bit.
struct PairGeometry {
    geometry::RpcCamera left;
    geometry::RpcCamera right; ///< with the correction that was found
    std::string frame_map;     ///< the map grid of the frame
    std::string output_map;    ///< and that of ground points
    geometry::ReferenceSurface surface;
    geometry::EpipolarFrame frame;
    geometry::GroundLattice ground;
    tiling::DisparityRange disparity;
    geometry::HeightSpan heights; ///< that the disparities stand for, above the ellipsoid
    std::optional<geometry::Pointing> pointing;
    std::vector<std::string> warnings;
};

/// Finds a pair's geometry from its images:
///
///     models, overlap -> reduced images, coarse frame -> features -> rough pointing, heights
///        -> reduced images matched -> range of heights -> frame -> features of patches at
///        full resolution -> pointing -> final frame, range and ground lattice
///
/// Reads each image through once and patches of it again; memory does not grow with them.
/// Throws InputError in a sentence that names the images where they make no pair, and
/// ConfigError for a map that cannot be used.
PairGeometry find_pair_geometry(const SensorImage& left, const SensorImage& right,
                                const PairGeometryOptions& options);

} // namespace hsgm::pipeline
