#include "pipeline/geometry/map_grid.h"

#include "pipeline/geometry/error.h"

#include <cmath>

namespace hsgm::geometry {

namespace {

double determinant(const std::array<double, 6>& t)
{
    return t[1] * t[5] - t[2] * t[4];
}

} // namespace

MapGrid::MapGrid(const std::array<double, 6>& corner_transform) : transform_(corner_transform)
{
    const double area = determinant(transform_);
    if (!std::isfinite(area) || area == 0) {
        throw GeometryError("its geotransform gives pixels without an area");
    }
}

MapPoint MapGrid::place_of(ImagePoint pixel) const
{
    const auto& t = transform_;
    const double col = pixel.x + 0.5;
    const double row = pixel.y + 0.5;
    return {t[0] + col * t[1] + row * t[2], t[3] + col * t[4] + row * t[5], 0};
}

ImagePoint MapGrid::pixel_of(double x, double y) const
{
    const auto& t = transform_;
    const double dx = x - t[0];
    const double dy = y - t[3];
    const double area = determinant(t);
    return {(dx * t[5] - dy * t[2]) / area - 0.5, (dy * t[1] - dx * t[4]) / area - 0.5};
}

MapGrid MapGrid::reduced(int factor) const
{
    MapGrid grid = *this;
    for (const std::size_t k : {1U, 2U, 4U, 5U}) {
        grid.transform_[k] *= factor;
    }
    return grid;
}

double MapGrid::step() const
{
    return std::sqrt(std::abs(determinant(transform_)));
}

} // namespace hsgm::geometry
