#pragma once

#include "pipeline/dsm/dsm_grid.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hsgm::dsm {

struct AreaPoint {
    double x = 0;
    double y = 0;
};
/// The corners of a closed line, in any direction; the last one is joined to the first.
using Ring = std::vector<AreaPoint>;

/// A part of the map bounded by rings: inside is what an odd number of them surrounds, so
/// rings may be islands, holes and islands in holes.
class CellArea {
public:
    /// Rings of fewer than three corners bound nothing.
    explicit CellArea(std::vector<Ring> rings);

    bool empty() const { return rings_.empty(); }
    const Bounds& bounds() const { return bounds_; }

    /// For each cell of a row, from `col` on: 1 where its centre lies inside, else 0. A cell's
    /// answer does not depend on which others are asked about.
    void mark(const DsmGrid& grid, int row, int col, std::span<std::uint8_t> inside) const;

private:
    std::vector<Ring> rings_;
    Bounds bounds_;
};

} // namespace hsgm::dsm
