#pragma once

#include "matcher/host/feature_planes.h"
#include "matcher/pixel.h"
#include "tiling/image.h"

#include <cstdint>

namespace hsgm::matcher::host {

/// Fills planes `plane`, `plane` + 1 and `plane` + 2 of `out` with the gradient along rows and
/// the least and largest of it within half a pixel (docs/algorithm.md, section 3). With
/// `tones`, three more with the tone, and the same of it. `image` must hold the rectangle of
/// `out` grown by 1 row and 2 columns and clipped to `full`, the size of the whole level.
/// Uses the caller's threads.
void gradients(const tiling::Patch<std::uint16_t>& image, tiling::Size full, Tone tone,
               int plane, bool tones, FeaturePlanes& out);

} // namespace hsgm::matcher::host
