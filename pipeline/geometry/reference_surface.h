#pragma once

#include "pipeline/geometry/points.h"
#include "tiling/image.h"

namespace hsgm::geometry {

/// The smooth surface on which both images of a pair are laid: level, or drawn through the
/// posts of a grid. A point on it has disparity 0.
class ReferenceSurface {
public:
    /// Level at this height.
    explicit ReferenceSurface(double height_m) : level_m_(height_m) {}

    /// Posts `step_m` apart, the first at (`west`, `north`), columns to the east, rows to the
    /// south; at least 4 x 4. Between them uniform cubic B-splines with the posts as control
    /// points: twice differentiable, and smoother than the posts themselves, so that it takes
    /// out the relief and not the noise. Beyond the outermost posts their heights go on,
    /// reached smoothly within two steps.
    ReferenceSurface(double west, double north, double step_m, tiling::Image<double> posts);

    double height_m(double x, double y) const;
    /// Height with its slope to the east and to the north, in metres per metre.
    double height_m(double x, double y, double& slope_x, double& slope_y) const;

    /// The same surface, so much higher.
    ReferenceSurface lifted(double by_m) const;

    bool is_level() const { return posts_.size().area() == 0; }
    double level_m() const { return level_m_; }
    double west() const { return west_; }
    double north() const { return north_; }
    double step_m() const { return step_m_; }
    const tiling::Image<double>& posts() const { return posts_; }

private:
    double level_m_ = 0; // the mean of the posts, where there are some
    double west_ = 0;
    double north_ = 0;
    double step_m_ = 1;
    tiling::Image<double> posts_;
};

} // namespace hsgm::geometry
