#pragma once

#include "pipeline/geometry/footprint.h"
#include "pipeline/geometry/ground_camera.h"
#include "pipeline/geometry/lattice.h"
#include "pipeline/geometry/reference_surface.h"
#include "tiling/rect.h"

#include <array>
#include <optional>

namespace hsgm::geometry {

/// A place in an epipolar frame, in its pixels: row and col, 0 at the centre of the first.
struct FramePoint {
    double row = 0;
    double col = 0;
};

/// One pair's common grid, laid on a reference surface in object space:
///
///     left camera                right camera
///                .              .
///                   .        .
///                      .  .                a point above the surface (here the crossing)
///                      .  .                appears on one row of both images, further along
///     ______________.________.______       it in the left one: d = col_left - col_right
///     surface      right    left           is positive; on the surface it is 0
///
/// Rows follow the direction of parallax, wherever that turns. The frame is computed once a
/// pair and then only read: its lattices define which pixel of a source a pixel of the frame
/// shows, so that everybody who has them agrees to the last bit.
struct EpipolarFrame {
    tiling::Size size;       ///< of both resampled images
    double gsd_m = 0;        ///< step of the grid along rows, and across them at its centre
    double images_gsd_m = 0; ///< geometric mean of both images' ground sampling distances
    double px_per_m = 0;  ///< disparity of a metre of height above the surface, at the centre
    double angle_rad = 0; ///< direction of the rows at the centre, anticlockwise from east
    double below_m = 0;   ///< heights over the surface that the frame was made for: lowest,
    double above_m = 0;   ///< highest
    Lattice map;          ///< x, y in metres, and height of the surface
    Lattice left;         ///< x, y in the left source image, pixels
    Lattice right;        ///< x, y in the right one
    /// How far the lattices are off the cameras, at worst, between their nodes.
    double lattice_error_px = 0;

    /// Place on the surface.
    MapPoint map_at(FramePoint place) const;
    ImagePoint left_at(FramePoint place) const;
    ImagePoint right_at(FramePoint place) const;
    /// The pixel above a place of the map, by Newton's method; nothing where it does not
    /// converge, which is far outside the frame.
    std::optional<FramePoint> frame_at(double x, double y) const;
};

/// What a frame is made for. Lengths are in metres.
struct FrameOptions {
    double gsd_m = 0;            ///< 0: the geometric mean of both images', times `finer`
    double finer = 1;            ///< above 0
    double below_m = -100;       ///< lowest height over the surface that matters
    double above_m = 100;        ///< highest
    Polygon region;              ///< convex part of the map that matters; empty: everything
    double tolerance_px = 0.005; ///< of the lattices

    /// Throws std::invalid_argument naming the option and what is allowed.
    void validate() const;
};

/// Lays the frame of a pair. Throws GeometryError for images that do not overlap (with where
/// each lies), a baseline that is too short to give heights (below 0.02 of the height), rays
/// that are nearly opposite, and a region outside the overlap.
EpipolarFrame make_epipolar_frame(const GroundCamera& left, tiling::Size left_size,
                                  const GroundCamera& right, tiling::Size right_size,
                                  const ReferenceSurface& surface, const FrameOptions& options);

} // namespace hsgm::geometry
