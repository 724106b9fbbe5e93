#pragma once

#include "matcher/pixel.h"
#include "tiling/image.h"

#include <array>
#include <cstdint>
#include <memory>

namespace hsgm::matcher {

/// Side of the blocks that noise is measured in, on a grid that begins at the image's corner.
constexpr int kNoiseBlock = 8;
constexpr int kMostNoise = 4095;

/// How much noise the blocks of an image hold: the standard deviation of each, in whole pixel
/// values (J. Immerkaer, Fast Noise Variance Estimation, CVIU 64(2), 1996; docs/algorithm.md,
/// section 1). A block with a nodata pixel, or where the estimate is exactly 0 (painted,
/// clipped or padded), does not count.
class NoiseCounts {
public:
    NoiseCounts() : counts_(std::make_unique<Counts>()) {}

    /// Counts the whole blocks of a strip that begins at a row of blocks and has the image's
    /// width; what does not fill a block is left out.
    void add(tiling::ImageView<const std::uint16_t> strip);
    /// Adds those of another part of the image.
    void add(const NoiseCounts& part);
    /// The noise of the calmest tenth of the blocks, which hold little else; 0 where none
    /// counts.
    int noise() const;

private:
    using Counts = std::array<std::uint64_t, kMostNoise + 1>;
    std::unique_ptr<Counts> counts_;
};

/// The noise of a whole image.
int noise_of(tiling::ImageView<const std::uint16_t> image);

/// One without noise that can be seen in its values makes the other's none: what one census
/// tells apart, both must.
void agree_on_noise(Tone& left, Tone& right);

} // namespace hsgm::matcher
