#include "pipeline/dsm/cell_area.h"

#include <algorithm>
#include <utility>

namespace hsgm::dsm {

namespace {

// Where the edges of a ring cross a horizontal line. An edge holds its lower end and not its
// upper one, so a line through a corner crosses as often as one beside it.
void add_crossings(const Ring& ring, double y, std::vector<double>& crossings)
{
    for (std::size_t i = 0; i < ring.size(); ++i) {
        // Always from south to north: an edge of two areas gives both the same number.
        const AreaPoint* low = &ring[i];
        const AreaPoint* high = &ring[(i + 1) % ring.size()];
        if (low->y > high->y) {
            std::swap(low, high);
        }
        if (low->y <= y && y < high->y) {
            crossings.push_back(low->x +
                                (y - low->y) * (high->x - low->x) / (high->y - low->y));
        }
    }
}

} // namespace

CellArea::CellArea(std::vector<Ring> rings) : rings_(std::move(rings))
{
    std::erase_if(rings_, [](const Ring& ring) { return ring.size() < 3; });
    for (const Ring& ring : rings_) {
        for (const AreaPoint& corner : ring) {
            bounds_.include(corner.x, corner.y);
        }
    }
}

void CellArea::mark(const DsmGrid& grid, int row, int col, std::span<std::uint8_t> inside) const
{
    std::vector<double> crossings;
    for (const Ring& ring : rings_) {
        add_crossings(ring, grid.y(row), crossings);
    }
    std::sort(crossings.begin(), crossings.end());
    std::size_t passed = 0;
    for (std::size_t i = 0; i < inside.size(); ++i) {
        const double x = grid.x(col + static_cast<int>(i));
        while (passed < crossings.size() && crossings[passed] <= x) {
            ++passed;
        }
        inside[i] = passed % 2;
    }
}

} // namespace hsgm::dsm
