#pragma once

#include "pipeline/synth/city.h"
#include "pipeline/synth/piece.h"
#include "pipeline/synth/scene.h"
#include "pipeline/synth/terrain.h"

#include <optional>
#include <vector>

namespace hsgm::synth {

/// A part of the continuous left image, x in [x_begin, x_end], y in [y_begin, y_end].
struct Area {
    double x_begin = 0;
    double x_end = 0;
    double y_begin = 0;
    double y_end = 0;
};

/// All surfaces of a scene: the ground, and the pieces of objects by place.
class Landscape {
public:
    /// Throws std::invalid_argument where the scene is not valid.
    explicit Landscape(const Scene& scene);

    const TerrainSurface& ground() const { return ground_; }

    /// Every piece that touches the area (and some that nearly do), in a fixed order.
    std::vector<Piece> pieces_over(const Area& area) const;

    /// Brightness of the ground, or of a piece, at a point of the left image.
    double ground_brightness(double x, double y) const;
    double piece_brightness(const Piece& piece, double x, double y) const;

    /// What contrast is scaled by at a point: 1 but in areas of low texture.
    double contrast_scale(double x, double y) const;

    /// Bounds of every disparity of the scene.
    DisparityBounds bounds() const { return bounds_; }

private:
    void append_city(const Area& area, std::vector<Piece>& pieces) const;

    Scene scene_;
    TerrainSurface ground_;
    std::vector<Piece> pieces_; ///< of the objects that the scene lists
    std::optional<CityMap> city_;
    DisparityBounds bounds_;
};

} // namespace hsgm::synth
