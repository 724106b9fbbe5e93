#pragma once

#include "matcher/pixel.h"
#include "tiling/image.h"

#include <cstdint>

namespace hsgm::matcher::host {

/// Tones (Tone::operator()) of `count` pixels.
void tone_run(Tone tone, const std::uint16_t* pixels, int count, std::uint8_t* out);

/// The 8-bit copy of an image part.
tiling::Patch<std::uint8_t> tones(const tiling::Patch<std::uint16_t>& image, Tone tone);

/// 1 where the valid tones of the 7 x 7 neighbourhood (clipped to the level) span less than
/// kTextureGate and the pixel itself is valid, else 0, for the pixels of `area`.
/// `image` and `tone` must hold `area` grown by 3 px and clipped to the level's image.
/// Uses the caller's threads.
tiling::Patch<std::uint8_t> low_texture(const tiling::Patch<std::uint16_t>& image,
                                        const tiling::Patch<std::uint8_t>& tone,
                                        const tiling::Rect& area);

} // namespace hsgm::matcher::host
