#pragma once

#include <cstdint>

namespace hsgm::matcher {

/// Pixels are 16-bit; this value means nodata. A valid 65535 is stored as 65534.
constexpr std::uint16_t kNodataPixel = 65535;

constexpr bool is_valid(std::uint16_t pixel)
{
    return pixel != kNodataPixel;
}

/// Maps 16-bit pixels to the 8-bit copy that penalties, texture gate and HMI use.
/// (0, 255) is the identity for 8-bit images.
struct Tone {
    int lo = 0;
    int hi = 255;
    int noise = 1; ///< standard deviation in pixel values, rounded

    constexpr std::uint8_t operator()(std::uint16_t pixel) const
    {
        if (!is_valid(pixel) || pixel <= lo) {
            return 0;
        }
        return static_cast<std::uint8_t>(pixel >= hi ? 255 : (pixel - lo) * 255 / (hi - lo));
    }
    /// The difference of values that ternary bits let pass: one tone, or 0 where noise is less
    /// than half a value, since ties say enough there.
    constexpr int tolerance() const { return noise == 0 ? 0 : (hi - lo + 127) / 255; }

    bool operator==(const Tone&) const = default;
};

} // namespace hsgm::matcher
