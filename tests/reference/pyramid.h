#pragma once

#include "matcher/options.h"
#include "tiling/disparity_range.h"
#include "tiling/image.h"

#include <cstdint>
#include <vector>

namespace hsgm::reference {

using matcher::Cost;
using matcher::Fill;
using matcher::Mode;
using matcher::Options;
using matcher::Subpixel;
using tiling::DisparityRange;
using tiling::Image;
using tiling::Rect;
using tiling::Size;

constexpr std::uint16_t kNodata = 65535;

/// The pixel at (row, col), coordinates clamped to the image.
template <typename T>
const T& clamped(const Image<T>& image, int row, int col)
{
    const int r = row < 0 ? 0 : row >= image.rows() ? image.rows() - 1 : row;
    const int c = col < 0 ? 0 : col >= image.cols() ? image.cols() - 1 : col;
    return image(r, c);
}

/// Section 1: the ends of an image's tone scale, and its noise.
struct ToneEnds {
    int lo = 0;
    int hi = 255;
    int noise = 1;
    bool operator==(const ToneEnds&) const = default;
};

/// The ends of an image that is not 8-bit, from its valid full-resolution pixels.
ToneEnds tone_ends(const Image<std::uint16_t>& image);
/// Section 1: the noise of an image, which its pair may still overrule.
int noise_of(const Image<std::uint16_t>& image);
/// The 8-bit copy of an image.
Image<std::uint8_t> toned(const Image<std::uint16_t>& image, ToneEnds ends);

/// Section 2: level k+1 of an image, from level k.
Image<std::uint16_t> reduced(const Image<std::uint16_t>& fine);
/// All levels of an image, level 0 (itself) first.
std::vector<Image<std::uint16_t>> pyramid(const Image<std::uint16_t>& image, int levels);

/// The number of levels K. `right` gives the width only; heights are equal.
int level_count(Size left, Size right, DisparityRange asked, const Options& options);
/// The disparity range of level k out of K.
DisparityRange level_range(DisparityRange asked, int k, int levels);

} // namespace hsgm::reference
