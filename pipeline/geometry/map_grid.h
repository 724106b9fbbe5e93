#pragma once

#include "pipeline/geometry/points.h"

#include <array>

namespace hsgm::geometry {

/// Where the pixels of a raster lie on a map: an affine grid, perhaps turned. Pixels count from
/// 0 at the centre of the first.
class MapGrid {
public:
    MapGrid() = default;
    /// From GDAL's six numbers, which speak of pixel corners:
    ///     x = t[0] + col * t[1] + row * t[2],   y = t[3] + col * t[4] + row * t[5]
    /// Throws GeometryError for pixels without an area.
    explicit MapGrid(const std::array<double, 6>& corner_transform);

    /// Place of a pixel, at height 0; what PROJ's maps count in.
    MapPoint place_of(ImagePoint pixel) const;
    ImagePoint pixel_of(double x, double y) const;
    /// The grid of an image whose pixels are the means of `factor` x `factor` of these.
    MapGrid reduced(int factor) const;
    /// Root of a pixel's area, in the map's units.
    double step() const;
    const std::array<double, 6>& corner_transform() const { return transform_; }

    bool operator==(const MapGrid&) const = default;

private:
    std::array<double, 6> transform_{0, 1, 0, 0, 0, -1};
};

} // namespace hsgm::geometry
