#include "matcher/host/texture.h"

#include "matcher/kernel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/texture.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef HSGM_MATCHER_HOST_TEXTURE_ONCE
#define HSGM_MATCHER_HOST_TEXTURE_ONCE
namespace hsgm::matcher::host {

struct TextureWork {
    const tiling::Patch<std::uint16_t>& image;
    const tiling::Patch<std::uint8_t>& tone;
    tiling::Patch<std::uint8_t>& out;
};

} // namespace hsgm::matcher::host
#endif

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// ------------------------------------------------------------------ tones, by the compiler

// (0, 255), the tones of 8-bit images.
void tones_of_bytes(const std::uint16_t* HWY_RESTRICT pixels, int count,
                    std::uint8_t* HWY_RESTRICT out)
{
    for (int i = 0; i < count; ++i) {
        const std::uint16_t pixel = pixels[i];
        const auto tone = static_cast<std::uint16_t>(pixel < 255 ? pixel : 255);
        out[i] = static_cast<std::uint8_t>(pixel == kNodataPixel ? 0 : tone);
    }
}

// Any others. The division (v - lo) * 255 / (hi - lo) is a multiplication by a rounded up
// reciprocal. With s = hi - lo < 2^b, n = (v - lo) * 255 < 2^(b + 8) and a reciprocal of
// 24 + b binary places the product is too large by less than 2^-16 <= 1 / s, which never
// reaches the next whole number.
void tones_of_words(Tone tone, const std::uint16_t* HWY_RESTRICT pixels, int count,
                    std::uint8_t* HWY_RESTRICT out)
{
    const auto span = static_cast<std::uint32_t>(tone.hi - tone.lo);
    const int places = 24 + static_cast<int>(std::bit_width(span));
    const auto reciprocal = static_cast<std::uint32_t>((std::uint64_t{1} << places) / span + 1);
    const auto lo = static_cast<std::uint32_t>(tone.lo);
    for (int i = 0; i < count; ++i) {
        const std::uint32_t pixel = pixels[i] == kNodataPixel ? 0 : pixels[i];
        const std::uint32_t above = std::min(pixel > lo ? pixel - lo : 0, span);
        out[i] = static_cast<std::uint8_t>((std::uint64_t{above * 255} * reciprocal) >> places);
    }
}

// ------------------------------------------------------------------ low texture

constexpr int kRadius = 3;
constexpr int kRows = 2 * kRadius + 1;
// Vectors may run this far over the end of a row.
constexpr int kSlack = 64;

// Least and largest tone of 7 pixels of a row, for the rows in reach.
class SpreadRows {
public:
    explicit SpreadRows(const TextureWork& work)
        : work_(work), cols_(work.out.rect.cols),
          pitch_(std::size_t(cols_ + 2 * kRadius + kSlack)), values_((2 * kRows + 2) * pitch_)
    {
    }

    const std::uint8_t* least(int row) const { return values_.data() + slot(row) * pitch_; }
    const std::uint8_t* most(int row) const { return least(row) + kRows * pitch_; }

    void load(int row)
    {
        const tiling::Rect& there = work_.image.rect;
        std::uint8_t* dark = values_.data() + 2 * kRows * pitch_;
        std::uint8_t* bright = dark + pitch_;
        std::fill_n(dark, pitch_, std::uint8_t{255});
        std::fill_n(bright, pitch_, std::uint8_t{0});
        const int first = work_.out.rect.col - kRadius;
        const int begin = std::max(first, there.col);
        const int end = std::min(first + cols_ + 2 * kRadius, there.col_end());
        if (row >= there.row && row < there.row_end()) {
            copy(&work_.image.at(row, begin), &work_.tone.at(row, begin), end - begin,
                 dark + (begin - first), bright + (begin - first));
        }
        spread(dark, bright, values_.data() + slot(row) * pitch_);
    }

private:
    std::size_t slot(int row) const { return std::size_t((row + kRows) % kRows); }

    // Nodata has tone 0, which raises no maximum; for the minimum it becomes 255.
    static void copy(const std::uint16_t* HWY_RESTRICT pixels,
                     const std::uint8_t* HWY_RESTRICT tone, int count,
                     std::uint8_t* HWY_RESTRICT dark, std::uint8_t* HWY_RESTRICT bright)
    {
        for (int i = 0; i < count; ++i) {
            dark[i] = pixels[i] == kNodataPixel ? 255 : tone[i];
            bright[i] = tone[i];
        }
    }

    void spread(const std::uint8_t* dark, const std::uint8_t* bright, std::uint8_t* least) const
    {
        const hn::ScalableTag<std::uint8_t> d;
        std::uint8_t* most = least + kRows * pitch_;
        for (std::size_t at = 0; at < std::size_t(cols_); at += hn::Lanes(d)) {
            auto low = hn::LoadU(d, dark + at);
            auto high = hn::LoadU(d, bright + at);
            for (std::size_t k = 1; k < kRows; ++k) {
                low = hn::Min(low, hn::LoadU(d, dark + at + k));
                high = hn::Max(high, hn::LoadU(d, bright + at + k));
            }
            hn::StoreU(low, d, least + at);
            hn::StoreU(high, d, most + at);
        }
    }

    const TextureWork& work_;
    int cols_;
    std::size_t pitch_;
    std::vector<std::uint8_t> values_;
};

// 1 where the tones of the 7 rows round `row` span less than the gate.
void gate_row(const SpreadRows& rows, int row, int cols, std::uint8_t* out)
{
    const hn::ScalableTag<std::uint8_t> d;
    const auto widest = hn::Set(d, std::uint8_t{kTextureGate - 1});
    for (std::size_t at = 0; at < std::size_t(cols); at += hn::Lanes(d)) {
        auto low = hn::LoadU(d, rows.least(row) + at);
        auto high = hn::LoadU(d, rows.most(row) + at);
        for (int other = row - kRadius; other <= row + kRadius; ++other) {
            low = hn::Min(low, hn::LoadU(d, rows.least(other) + at));
            high = hn::Max(high, hn::LoadU(d, rows.most(other) + at));
        }
        const auto span = hn::Sub(high, low);
        const auto flat = hn::Eq(hn::Min(span, widest), span);
        hn::StoreU(hn::IfThenElseZero(flat, hn::Set(d, std::uint8_t{1})), d, out + at);
    }
}

void low_texture_rows(const TextureWork& work, int row_begin, int row_end)
{
    const tiling::Rect& area = work.out.rect;
    SpreadRows rows(work);
    std::vector<std::uint8_t> flat(std::size_t(area.cols + kSlack));
    for (int row = row_begin - kRadius; row < row_begin + kRadius; ++row) {
        rows.load(row);
    }
    for (int row = row_begin; row < row_end; ++row) {
        rows.load(row + kRadius);
        gate_row(rows, row, area.cols, flat.data());
        const std::uint16_t* HWY_RESTRICT pixels = &work.image.at(row, area.col);
        std::uint8_t* HWY_RESTRICT out = &work.out.at(row, area.col);
        for (int i = 0; i < area.cols; ++i) {
            out[i] = pixels[i] == kNodataPixel ? 0 : flat[std::size_t(i)];
        }
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

using tiling::Patch;
using tiling::Rect;

HWY_EXPORT(tones_of_bytes);
HWY_EXPORT(tones_of_words);
HWY_EXPORT(low_texture_rows);

void tone_run(Tone tone, const std::uint16_t* pixels, int count, std::uint8_t* out)
{
    if (tone.lo == 0 && tone.hi == 255) {
        HWY_DYNAMIC_DISPATCH(tones_of_bytes)(pixels, count, out);
    } else {
        HWY_DYNAMIC_DISPATCH(tones_of_words)(tone, pixels, count, out);
    }
}

Patch<std::uint8_t> tones(const Patch<std::uint16_t>& image, Tone tone)
{
    Patch<std::uint8_t> result(image.rect);
    for (int row = 0; row < image.rect.rows; ++row) {
        tone_run(tone, image.pixels.row(row), image.rect.cols, result.pixels.row(row));
    }
    return result;
}

Patch<std::uint8_t> low_texture(const Patch<std::uint16_t>& image,
                                const Patch<std::uint8_t>& tone, const Rect& area)
{
    Patch<std::uint8_t> result(area);
    const TextureWork work{image, tone, result};
    tbb::parallel_for(tbb::blocked_range<int>(area.row, area.row_end(), 64),
                      [&](const tbb::blocked_range<int>& rows) {
                          HWY_DYNAMIC_DISPATCH(low_texture_rows)
                          (work, rows.begin(), rows.end());
                      });
    return result;
}

} // namespace hsgm::matcher::host
#endif
