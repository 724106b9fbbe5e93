#pragma once

#include "tiling/rect.h"

#include <array>
#include <cstdint>
#include <limits>

namespace hsgm::dsm {

/// What lies between two pairs of map coordinates; empty until something is included.
struct Bounds {
    double west = std::numeric_limits<double>::infinity();
    double south = std::numeric_limits<double>::infinity();
    double east = -std::numeric_limits<double>::infinity();
    double north = -std::numeric_limits<double>::infinity();

    bool empty() const { return !(west <= east && south <= north); }
    void include(double x, double y);
    void include(const Bounds& other);
    /// Whether the two share anything once this one is wider by `margin` on each side.
    bool meets(const Bounds& other, double margin) const;
};

/// Square cells on a map, north up, whose lines lie on whole multiples of the cell size: two
/// grids of one size and map fit each other, wherever they begin.
struct DsmGrid {
    std::int64_t first_row = 0; ///< cells from the map's origin to the south
    std::int64_t first_col = 0; ///< and to the east
    double cell = 1;            ///< side of a cell in the map's units
    tiling::Size size;

    double west() const { return static_cast<double>(first_col) * cell; }
    double north() const { return -static_cast<double>(first_row) * cell; }
    /// Of a cell's centre.
    double x(int col) const { return (static_cast<double>(first_col + col) + 0.5) * cell; }
    double y(int row) const { return -(static_cast<double>(first_row + row) + 0.5) * cell; }
    /// What some of its cells cover.
    Bounds bounds(const tiling::Rect& cells) const;
    /// Map from pixel corners, in GDAL's order.
    std::array<double, 6> transform() const { return {west(), cell, 0, north(), 0, -cell}; }
};

/// The least grid that covers the bounds. Throws std::invalid_argument for empty bounds, a
/// cell that is not above 0, or more than 2^31 - 1 rows or columns.
DsmGrid make_grid(const Bounds& bounds, double cell);

/// A round number near the ground sampling distance of images: 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6,
/// 7 or 8 times a power of ten.
double cell_for(double gsd);

} // namespace hsgm::dsm
