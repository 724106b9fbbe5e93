#pragma once

#include "pipeline/synth/scene.h"

#include <vector>

namespace hsgm::synth {

/// sin(2 pi t), to about 1e-15. Our own, because libm's last bit differs between machines
/// and a truth raster should not.
double sine_of_turns(double turns);
inline double cosine_of_turns(double turns)
{
    return sine_of_turns(turns + 0.25);
}

struct DisparityBounds {
    double min_px = 0;
    double max_px = 0;
};

/// The ground's disparity as seen from both images.
class TerrainSurface {
public:
    explicit TerrainSurface(const Terrain& terrain);

    /// Disparity at the left image's (x, y).
    double disparity(double x, double y) const;
    double slope_x(double x, double y) const;

    /// Disparity of the ground that projects to the right image's (x_right, y): the d with
    /// disparity(x_right + d, y) = d, to 1e-11 px. Unique, because the slope stays below 0.5.
    double disparity_from_right(double x_right, double y) const;

    /// An upper bound of |slope_x| anywhere.
    double steepest_slope_x() const;
    /// Bounds over both views of this size, and `margin_px` round them.
    DisparityBounds bounds(tiling::Size size, double margin_px) const;

private:
    struct Sinusoid {
        double amplitude_px;
        double turns_per_col;
        double turns_per_row;
        double phase_turns;
    };
    double offset_px_;
    double slope_x_;
    double slope_y_;
    std::vector<Sinusoid> waves_;
};

} // namespace hsgm::synth
