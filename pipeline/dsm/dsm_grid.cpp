#include "pipeline/dsm/dsm_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace hsgm::dsm {

void Bounds::include(double x, double y)
{
    west = std::min(west, x);
    east = std::max(east, x);
    south = std::min(south, y);
    north = std::max(north, y);
}

void Bounds::include(const Bounds& other)
{
    if (!other.empty()) {
        include(other.west, other.south);
        include(other.east, other.north);
    }
}

bool Bounds::meets(const Bounds& other, double margin) const
{
    return west - margin <= other.east && other.west <= east + margin &&
           south - margin <= other.north && other.south <= north + margin;
}

Bounds DsmGrid::bounds(const tiling::Rect& cells) const
{
    const auto at = [this](std::int64_t lines) { return static_cast<double>(lines) * cell; };
    return {at(first_col + cells.col), -at(first_row + cells.row_end()),
            at(first_col + cells.col_end()), -at(first_row + cells.row)};
}

DsmGrid make_grid(const Bounds& bounds, double cell)
{
    if (!(cell > 0) || bounds.empty()) {
        throw std::invalid_argument("a DSM needs a cell size above 0 and points to cover");
    }
    DsmGrid grid;
    grid.cell = cell;
    grid.first_col = static_cast<std::int64_t>(std::floor(bounds.west / cell));
    grid.first_row = static_cast<std::int64_t>(std::floor(-bounds.north / cell));
    const double cols =
        std::floor(bounds.east / cell) - static_cast<double>(grid.first_col) + 1;
    const double rows =
        std::floor(-bounds.south / cell) - static_cast<double>(grid.first_row) + 1;
    constexpr double kMost = std::numeric_limits<int>::max();
    if (cols > kMost || rows > kMost) {
        throw std::invalid_argument("a DSM with cells of " + std::to_string(cell) +
                                    " would have too many of them");
    }
    grid.size = {static_cast<int>(rows), static_cast<int>(cols)};
    return grid;
}

double cell_for(double gsd)
{
    static constexpr std::array<int, 12> kDigits{10, 12, 15, 20, 25, 30,
                                                 40, 50, 60, 70, 80, 100};
    const double power = std::pow(10.0, std::floor(std::log10(gsd)) - 1);
    const double digits = gsd / power;
    const int nearest =
        *std::min_element(kDigits.begin(), kDigits.end(), [digits](int a, int b) {
            return std::abs(a - digits) < std::abs(b - digits);
        });
    // Multiples of a power below 1 by division, which gives the number that people write.
    const double inverse = std::round(1 / power);
    return power < 1 ? nearest / inverse : nearest * power;
}

} // namespace hsgm::dsm
