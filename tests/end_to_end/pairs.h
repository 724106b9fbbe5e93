#pragma once

#include "tests/unit/io/sample_rasters.h"

#include <cstdint>
#include <string>
#include <vector>

namespace hsgm::tests {

using io::samples::make_raster;
using io::samples::put_bytes;
using io::samples::TemporaryFolder;
using Pixels = std::vector<double>;

/// Grey levels 1..255 without pattern. A plain recipe, the same everywhere.
inline Pixels noise(tiling::Size size, std::uint32_t seed = 1)
{
    Pixels pixels(static_cast<std::size_t>(size.area()));
    std::uint32_t state = seed;
    for (double& pixel : pixels) {
        state = state * 1664525U + 1013904223U;
        pixel = 1 + (state >> 16) % 255;
    }
    return pixels;
}

/// The right image of a scene whose disparity is `shift_px` (not negative) everywhere; what the
/// left image does not show comes from its other end.
inline Pixels shifted(const Pixels& left, tiling::Size size, int shift_px)
{
    const auto cols = static_cast<std::size_t>(size.cols);
    Pixels right(left.size());
    for (std::size_t i = 0; i < left.size(); ++i) {
        const std::size_t row_begin = i - i % cols;
        right[i] = left[row_begin + (i + static_cast<std::size_t>(shift_px)) % cols];
    }
    return right;
}

/// left.tif and right.tif of noise with a disparity of 5 px.
inline void make_pair(const TemporaryFolder& folder, tiling::Size size = {60, 90})
{
    const Pixels left = noise(size);
    make_raster(folder / "left.tif", GDT_Byte, size, {left});
    make_raster(folder / "right.tif", GDT_Byte, size, {shifted(left, size, 5)});
}

/// The least configuration of that pair. `more` follows the range in `matcher`.
inline std::string pair_config(const std::string& more = "")
{
    return "pair: {left: left.tif, right: right.tif}\n"
           "geometry: {kind: rectified}\n"
           "output: {folder: result}\n"
           "matcher: {disparity: [0, 10]" +
           more + "}\n";
}

} // namespace hsgm::tests
