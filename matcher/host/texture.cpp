#include "matcher/host/texture.h"

#include "matcher/kernel.h"

#include <algorithm>

namespace hsgm::matcher::host {

namespace {

using tiling::Image;
using tiling::Patch;
using tiling::Rect;

constexpr int kRadius = 3;

// For every pixel, the least (or most) of up to 7 neighbours along its row.
template <typename Pick>
void spread_along_row(const std::uint8_t* in, int cols, Pick pick, std::uint8_t* out)
{
    std::copy_n(in, cols, out);
    for (int step = 1; step <= kRadius; ++step) {
        for (int c = 0; c + step < cols; ++c) {
            out[c] = pick(out[c], in[c + step]);
        }
        for (int c = step; c < cols; ++c) {
            out[c] = pick(out[c], in[c - step]);
        }
    }
}

template <typename Pick>
void spread_along_cols(const Image<std::uint8_t>& in, int row, Pick pick, std::uint8_t* out)
{
    std::copy_n(in.row(row), in.cols(), out);
    const int begin = std::max(0, row - kRadius);
    const int end = std::min(in.rows(), row + kRadius + 1);
    for (int r = begin; r < end; ++r) {
        const std::uint8_t* values = in.row(r);
        for (int c = 0; c < in.cols(); ++c) {
            out[c] = pick(out[c], values[c]);
        }
    }
}

constexpr auto kLeast = [](std::uint8_t a, std::uint8_t b) { return std::min(a, b); };
constexpr auto kMost = [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); };

} // namespace

Patch<std::uint8_t> tones(const Patch<std::uint16_t>& image, Tone tone)
{
    Patch<std::uint8_t> result(image.rect);
    const auto from = image.pixels.pixels();
    std::transform(from.begin(), from.end(), result.pixels.data(), tone);
    return result;
}

Patch<std::uint8_t> low_texture(const Patch<std::uint16_t>& image,
                                const Patch<std::uint8_t>& tone, const Rect& area)
{
    const Rect read = intersect(expand(area, kRadius), image.rect);
    Image<std::uint8_t> least(read.size());
    Image<std::uint8_t> most(read.size());
    std::vector<std::uint8_t> row_values(std::size_t(read.cols));
    for (int r = 0; r < read.rows; ++r) {
        // Nodata has tone 0, which raises no maximum; for the minimum it becomes 255.
        const std::uint8_t* t = &tone.at(read.row + r, read.col);
        const std::uint16_t* pixel = &image.at(read.row + r, read.col);
        spread_along_row(t, read.cols, kMost, most.row(r));
        for (int c = 0; c < read.cols; ++c) {
            row_values[std::size_t(c)] = is_valid(pixel[c]) ? t[c] : std::uint8_t{255};
        }
        spread_along_row(row_values.data(), read.cols, kLeast, least.row(r));
    }
    Patch<std::uint8_t> result(area);
    std::vector<std::uint8_t> top(std::size_t(read.cols));
    for (int row = area.row; row < area.row_end(); ++row) {
        spread_along_cols(least, row - read.row, kLeast, row_values.data());
        spread_along_cols(most, row - read.row, kMost, top.data());
        for (int col = area.col; col < area.col_end(); ++col) {
            const std::size_t c = std::size_t(col - read.col);
            result.at(row, col) =
                is_valid(image.at(row, col)) && top[c] - row_values[c] < kTextureGate;
        }
    }
    return result;
}

} // namespace hsgm::matcher::host
