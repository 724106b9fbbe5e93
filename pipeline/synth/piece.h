#pragma once

#include "pipeline/synth/scene.h"
#include "pipeline/synth/terrain.h"

#include <cstdint>
#include <vector>

namespace hsgm::synth {

enum class View { left, right };

/// A convex footprint in the left image with one plane of disparity: a flat roof, or one
/// side of a gable. What the renderer knows of objects.
struct Piece {
    // Footprint, in axes u (along the length) and v (across) through the centre.
    double center_x = 0;
    double center_y = 0;
    double cos_angle = 1;
    double sin_angle = 0;
    double u_half = 0;
    double v_begin = 0;
    double v_end = 0;
    bool ellipse = false; ///< cut by the ellipse with the half axes below
    double ellipse_v_half = 0;

    // Disparity at the centre and its gradient, per column and per row.
    double disparity_px = 0;
    double slope_x = 0;
    double slope_y = 0;

    Texture texture;
    std::uint64_t seed = 0;

    double disparity(double x, double y) const
    {
        return disparity_px + slope_x * (x - center_x) + slope_y * (y - center_y);
    }
    /// No pixel of the footprint is farther from the centre.
    double radius_px() const;
    /// No point of the piece has a larger disparity.
    double highest_px() const;
};

/// Where a piece is on one image row, in the columns of one view, and its disparity there:
/// at_zero + slope * column. Along a row a plane is a line in both views.
struct Span {
    double begin = 0;
    double end = 0; ///< exclusive; empty if not above begin
    double at_zero = 0;
    double slope = 0;

    bool covers(double column) const { return column >= begin && column < end; }
    double disparity(double column) const { return at_zero + slope * column; }
};

/// The piece on row `y` (continuous) as `view` would show it with nothing in front.
Span span_on_row(const Piece& piece, View view, double y);

/// Cuts an object into pieces; its eaves are `height_px` above the ground at its centre.
void append_pieces(const Object& object, std::uint64_t seed, const TerrainSurface& ground,
                   std::vector<Piece>& pieces);

} // namespace hsgm::synth
