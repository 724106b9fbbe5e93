#pragma once

#include "matcher/host/feature_planes.h"
#include "tiling/image.h"

#include <cstdint>

namespace hsgm::matcher::host {

/// The neighbourhood of a census.
struct CensusShape {
    int radius_rows;
    int radius_cols;

    int bits() const { return (2 * radius_rows + 1) * (2 * radius_cols + 1) - 1; }
    int planes() const { return (bits() + 7) / 8; }
};

/// Fills the first planes of `out` with census bits of its pixels: one bit for each
/// neighbour, set where it is darker than the centre (docs/algorithm.md, section 3). `image`
/// must hold the rectangle of `out` grown by the radii and clipped to `full`, the size of the
/// whole level, at whose borders neighbours are replicated. Nodata neighbours are never darker.
/// Uses the caller's threads.
void census(const tiling::Patch<std::uint16_t>& image, tiling::Size full, CensusShape shape,
            FeaturePlanes& out);

} // namespace hsgm::matcher::host
