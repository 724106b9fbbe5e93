#pragma once

#include "matcher/host/census_pattern.h"
#include "matcher/host/feature_planes.h"
#include "tiling/image.h"

#include <cstdint>
#include <span>

namespace hsgm::matcher::host {

/// Fills the first planes of `out` with the bits of its pixels (docs/algorithm.md, section
/// 3), eight to a plane: whether the pixel at `less` is below the one at `more` by more than
/// `tolerance` (>= 0). A bit that looks at nodata is 0. `image` must hold the rectangle of
/// `out` grown by the reach of the bits and clipped to `full`, the size of the whole level, at
/// whose borders pixels are replicated. Uses the caller's threads.
void census(const tiling::Patch<std::uint16_t>& image, tiling::Size full,
            std::span<const CensusBit> bits, int tolerance, FeaturePlanes& out);

} // namespace hsgm::matcher::host
