#pragma once

#include "pipeline/synth/landscape.h"
#include "pipeline/synth/piece.h"

#include <vector>

namespace hsgm::synth {

/// A line of sight over the map. In scenes seen by cameras on orbit x and y count the map's
/// cells (integer at cell centres, y to the south), and what rectified pairs call disparity
/// is the height in metres above the scene's base.
struct Ray {
    double x = 0; ///< where it passes height 0
    double y = 0;
    double x_per_m = 0; ///< how it leans: cells per metre of height
    double y_per_m = 0;

    double x_at(double height_m) const { return x + x_per_m * height_m; }
    double y_at(double height_m) const { return y + y_per_m * height_m; }
};

enum class Surface { ground, roof, wall };

/// The highest point of a ray that meets the scene: what a camera sees along it.
struct Hit {
    Surface surface = Surface::ground;
    double height_m = 0;
    const Piece* piece = nullptr; ///< of roofs and walls

    /// Which surface it is, without where.
    bool same_surface(const Hit& other) const
    {
        return surface == other.surface && piece == other.piece;
    }
};

/// Casts rays at a part of a scene: the ground, and objects with roofs and upright walls.
class RayCaster {
public:
    /// For rays that stay over `area` between the scene's lowest and highest point.
    RayCaster(const Landscape& landscape, const Area& area)
        : landscape_(landscape), pieces_(landscape.pieces_over(area))
    {
    }

    /// Where the ray, coming from above, first meets a surface. A ray may lean by 2 cells per
    /// metre at most, since the ground is solved for by iteration.
    Hit first_hit(const Ray& ray) const;

    /// How bright the surface is at the hit; walls are darker than their roofs.
    double brightness(const Ray& ray, const Hit& hit) const;

private:
    const Landscape& landscape_;
    std::vector<Piece> pieces_;
};

} // namespace hsgm::synth
