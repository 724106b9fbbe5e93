#pragma once

#include "pipeline/geometry/ground_camera.h"

#include <cmath>

namespace hsgm::geometry::samples {

/// A camera of parallel rays: a place at height h appears where the map, moved by
/// (lean_x, lean_y) metres for a metre down, has it; `gsd_m` to a pixel, x to the east and y
/// to the south, `turn_rad` anticlockwise about the image's first pixel. Its epipolar geometry
/// is known in closed form.
class ParallelCamera final : public GroundCamera {
public:
    double west = 0; ///< place of the centre of the first pixel at height 0
    double north = 0;
    double gsd_m = 0.5;
    double lean_x = 0;
    double lean_y = 0;
    double turn_rad = 0;

    ImagePoint project(const MapPoint& p) const override
    {
        const double east = (p.x - lean_x * p.height_m - west) / gsd_m;
        const double south = (north - (p.y - lean_y * p.height_m)) / gsd_m;
        return {std::cos(turn_rad) * east - std::sin(turn_rad) * south,
                std::sin(turn_rad) * east + std::cos(turn_rad) * south};
    }
    std::optional<MapPoint> locate(ImagePoint image, double height_m) const override
    {
        const double east = std::cos(turn_rad) * image.x + std::sin(turn_rad) * image.y;
        const double south = -std::sin(turn_rad) * image.x + std::cos(turn_rad) * image.y;
        return MapPoint{west + east * gsd_m + lean_x * height_m,
                        north - south * gsd_m + lean_y * height_m, height_m};
    }
};

} // namespace hsgm::geometry::samples
