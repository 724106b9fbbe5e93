#pragma once

#include "tiling/image.h"

#include <cstdint>

namespace hsgm::matcher::host {

/// Census words of the pixels of `area`: one bit for each neighbour within the radii, set
/// where it is darker than the centre (docs/algorithm.md, section 3). `image` must hold
/// `area` grown by the radii and clipped to `full`, the size of the whole level, at whose
/// borders neighbours are replicated. Nodata neighbours (65535) are never darker.
/// Uses the caller's threads.
tiling::Patch<std::uint64_t> census(const tiling::Patch<std::uint16_t>& image,
                                    tiling::Size full, int radius_rows, int radius_cols,
                                    const tiling::Rect& area);

} // namespace hsgm::matcher::host
