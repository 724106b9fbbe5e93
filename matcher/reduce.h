#pragma once

#include "tiling/image.h"

#include <cstdint>

namespace hsgm::matcher {

/// One pyramid step (docs/algorithm.md, section 2): the pixels `coarse` of the next coarser
/// level from a part of the finer one. `fine` must hold pyramid_taps(coarse) clipped to
/// `fine_size`, the size of the whole finer level; taps are replicated at its borders only.
/// Nodata taps (65535) are left out of the weighted mean.
void reduce(const tiling::Patch<std::uint16_t>& fine, tiling::Size fine_size,
            const tiling::Rect& coarse, tiling::ImageView<std::uint16_t> result);

} // namespace hsgm::matcher
