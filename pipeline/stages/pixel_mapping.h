#pragma once

#include "matcher/pixel.h"
#include "pipeline/stages/pixel_source.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>

namespace hsgm::pipeline {

/// Turns stored numbers into the matcher's 16-bit pixels. 8-bit and uint16 sources keep their
/// values (65535 becomes 65534, since 65535 means nodata); other types are mapped by one
/// linear function for both images of the pair, so that equal values stay equal.
struct PixelMapping {
    double offset = 0;
    double scale = 1;

    std::uint16_t operator()(double value) const
    {
        if (std::isnan(value)) {
            return matcher::kNodataPixel;
        }
        const double mapped = std::floor((value - offset) * scale + 0.5);
        return static_cast<std::uint16_t>(mapped < 0 ? 0 : mapped > 65534 ? 65534 : mapped);
    }
};

/// The mapping of a pair. Reads both images through once unless their types need none.
/// Integers whose span fits 16 bits are only shifted.
PixelMapping find_mapping(PixelSource& left, PixelSource& right);

/// Counts of every valid pixel value of an image.
using PixelHistogram = std::array<std::uint64_t, 65536>;

/// The tone of an image from its type and its full-resolution histogram: the identity for
/// 8-bit images, else between the 0.1 and 99.9 percentiles (docs/algorithm.md, section 1).
matcher::Tone find_tone(io::PixelType type, const PixelHistogram& histogram);

} // namespace hsgm::pipeline
