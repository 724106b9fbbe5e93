#pragma once

#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/geometry/ground_camera.h"
#include "pipeline/geometry/lattice.h"

#include <functional>
#include <span>
#include <vector>

namespace hsgm::geometry {

/// Where two rays meet: the place that both images show with the least sum of squared
/// distances in their pixels.
struct Meeting {
    MapPoint place;
    double residual_px = 0; ///< root mean square of the four distances in x and y
};

/// Meets the rays of one point of each image, from `start` on, by Gauss and Newton's method.
/// Nothing where they do not meet (nearly parallel, or behind the cameras).
std::optional<Meeting> meet_rays(const GroundCamera& left, ImagePoint in_left,
                                 const GroundCamera& right, ImagePoint in_right,
                                 const MapPoint& start);

/// Turns a place of the frame's map into the one that is wanted in the end.
using ToOutput = std::function<MapPoint(const MapPoint&)>;

/// The ground point of every (row, col, disparity) of a frame: exact at nodes, cubic in all
/// three directions between them. Immutable; threads may share one.
class GroundLattice {
public:
    /// One row of results, each span as long as the row of disparities.
    struct Row {
        std::span<double> x;
        std::span<double> y;
        std::span<double> height_m;
        std::span<float> residual_px;
    };

    /// A lattice for disparities from `disparity_min_px` to `disparity_max_px`, dense enough
    /// that between its nodes it is within `tolerance` (a share of the frame's gsd) of the
    /// rays' meeting. Throws GeometryError where rays do not meet.
    GroundLattice(const EpipolarFrame& frame, const GroundCamera& left,
                  const GroundCamera& right, double disparity_min_px, double disparity_max_px,
                  const ToOutput& to_output, double tolerance = 0.01);
    /// One that was stored.
    GroundLattice(Lattice nodes, double disparity_min_px, double disparity_max_px,
                  double error_m);

    /// The points of a row of disparities, which begins at (row, col) of the frame; NaN where a
    /// disparity is NaN. Depends on nothing else.
    void points(int row, int col, std::span<const float> disparity_px, const Row& result) const;
    Meeting at(FramePoint place, double disparity_px) const;

    const Lattice& nodes() const { return nodes_; }
    double disparity_min_px() const { return disparity_min_px_; }
    double disparity_max_px() const { return disparity_max_px_; }
    /// The worst distance from the rays' meeting found between nodes.
    double error_m() const { return error_m_; }

private:
    Lattice nodes_; ///< x, y, height and residual at each of four disparities
    double disparity_min_px_ = 0;
    double disparity_max_px_ = 0;
    double error_m_ = 0;
};

} // namespace hsgm::geometry
