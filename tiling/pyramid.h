#pragma once

#include "tiling/disparity_range.h"
#include "tiling/rect.h"

#include <vector>

namespace hsgm::tiling {

/// Image sizes of levels 0..levels-1; each is half the one before, rounded up.
std::vector<Size> pyramid_sizes(Size full, int levels);

/// The pixels of the finer level that a pixel of `coarse` (one level coarser) is made of:
/// rows 2r-1..2r+2 and columns 2c-1..2c+2 (the taps 1-3-3-1). Not clipped.
Rect pyramid_taps(const Rect& coarse);

/// Disparity ranges of levels 0..levels-1 for the asked range. Level 0 is the asked range
/// itself; coarser ones come from it after widening to whole multiples of 2^(levels-1),
/// so that every level halves without remainder.
std::vector<DisparityRange> pyramid_ranges(DisparityRange asked, int levels);

} // namespace hsgm::tiling
