#include "matcher/host/gradient.h"

#include "matcher/host/texture.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/gradient.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef HSGM_MATCHER_HOST_GRADIENT_ONCE
#define HSGM_MATCHER_HOST_GRADIENT_ONCE
namespace hsgm::matcher::host {

struct GradientWork {
    const tiling::Patch<std::uint16_t>& image;
    tiling::Size full;
    Tone tone;
    int plane;
    bool tones;
    FeaturePlanes& out;
};

} // namespace hsgm::matcher::host
#endif

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kClip = 15;
// Columns that are read beside those computed: one for a gradient, one for its neighbour's.
constexpr int kBeside = 2;
constexpr int kRows = 3;
// Vectors may run this far over the end of a row.
constexpr int kSlack = 64;

using Bytes = std::vector<std::uint8_t>;

// Tones of a row, and 255 where they are valid, replicated at the image's borders. The first
// entry is kBeside columns before the rectangle's first.
struct ToneRow {
    Bytes tone;
    Bytes valid;

    void load(const GradientWork& work, int row)
    {
        const tiling::Rect& rect = work.out.rect();
        const auto length = std::size_t(rect.cols + 2 * kBeside);
        tone.resize(length + kSlack);
        valid.resize(length + kSlack);
        const int first = rect.col - kBeside;
        const int begin = std::max(first, 0);
        const int end = std::min(rect.col_end() + kBeside, work.full.cols);
        const auto before = std::size_t(begin - first);
        const auto inside = std::size_t(end - begin);
        const std::uint16_t* HWY_RESTRICT pixels =
            &work.image.at(std::clamp(row, 0, work.full.rows - 1), begin);
        tone_run(work.tone, pixels, end - begin, tone.data() + before);
        std::uint8_t* HWY_RESTRICT flags = valid.data() + before;
        for (std::size_t i = 0; i < inside; ++i) {
            flags[i] = pixels[i] == kNodataPixel ? 0 : 255;
        }
        for (Bytes* bytes : {&tone, &valid}) {
            std::fill_n(bytes->begin(), before, (*bytes)[before]);
            std::fill(bytes->begin() + std::ptrdiff_t(before + inside),
                      bytes->begin() + std::ptrdiff_t(length), (*bytes)[before + inside - 1]);
        }
    }
};

// tone(i + 2) - tone(i) of a row, 0 if either is nodata.
template <class D16>
HWY_INLINE hn::Vec<D16> difference(D16 d16, const ToneRow& row, std::size_t i)
{
    const hn::Rebind<std::uint8_t, D16> d8;
    const auto valid =
        hn::And(hn::LoadU(d8, row.valid.data() + i), hn::LoadU(d8, row.valid.data() + i + 2));
    const auto left = hn::And(valid, hn::LoadU(d8, row.tone.data() + i));
    const auto right = hn::And(valid, hn::LoadU(d8, row.tone.data() + i + 2));
    return hn::Sub(hn::PromoteTo(d16, right), hn::PromoteTo(d16, left));
}

// Clipped gradients, the first one column before the rectangle's.
void gradient_row(const ToneRow& above, const ToneRow& here, const ToneRow& below,
                  std::size_t count, std::uint8_t* HWY_RESTRICT out)
{
    const hn::ScalableTag<std::int16_t> d16;
    const hn::Rebind<std::uint8_t, decltype(d16)> d8;
    const auto clip = hn::Set(d16, std::int16_t{kClip});
    const auto zero = hn::Zero(d16);
    for (std::size_t i = 0; i < count; i += hn::Lanes(d16)) {
        const auto middle = difference(d16, here, i);
        const auto sides = hn::Add(difference(d16, above, i), difference(d16, below, i));
        const auto sum = hn::Add(hn::Add(middle, middle), sides);
        const auto clipped = hn::Min(hn::Max(sum, hn::Sub(zero, clip)), clip);
        hn::StoreU(hn::DemoteTo(d8, hn::Add(clipped, clip)), d8, out + i);
    }
}

// Mean of a value and that of a neighbour, if it has one (255 in `valid`).
template <class D>
HWY_INLINE hn::Vec<D> mean(D d, hn::Vec<D> here, const std::uint8_t* values,
                           const std::uint8_t* valid)
{
    const auto there = hn::LoadU(d, values);
    const auto has_value = hn::Ne(hn::LoadU(d, valid), hn::Zero(d));
    return hn::AverageRound(here, hn::IfThenElse(has_value, there, here));
}

// Of each value from the second on, the least and largest of it and of its means with both
// neighbours.
void half_way(const std::uint8_t* values, const std::uint8_t* valid, std::size_t count,
              std::uint8_t* HWY_RESTRICT least, std::uint8_t* HWY_RESTRICT most)
{
    const hn::ScalableTag<std::uint8_t> d;
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
        const auto here = hn::LoadU(d, values + i + 1);
        const auto before = mean(d, here, values + i, valid + i);
        const auto after = mean(d, here, values + i + 2, valid + i + 2);
        hn::StoreU(hn::Min(here, hn::Min(before, after)), d, least + i);
        hn::StoreU(hn::Max(here, hn::Max(before, after)), d, most + i);
    }
}

class GradientRows {
public:
    explicit GradientRows(const GradientWork& work)
        : work_(work), cols_(std::size_t(work.out.rect().cols)), gradient_(cols_ + 2 + kSlack),
          least_(cols_ + kSlack), most_(cols_ + kSlack)
    {
    }

    void run(int row_begin, int row_end)
    {
        at(row_begin - 1).load(work_, row_begin - 1);
        at(row_begin).load(work_, row_begin);
        for (int row = row_begin; row < row_end; ++row) {
            at(row + 1).load(work_, row + 1);
            write_gradients(row);
            if (work_.tones) {
                write(work_.plane + 3, row, at(row).tone.data() + 1);
            }
        }
    }

private:
    ToneRow& at(int row) { return rows_[std::size_t((row + kRows) % kRows)]; }

    void write_gradients(int row)
    {
        gradient_row(at(row - 1), at(row), at(row + 1), cols_ + 2, gradient_.data());
        // The neighbours of the image's first and last column are these themselves.
        if (work_.out.rect().col == 0) {
            gradient_[0] = gradient_[1];
        }
        if (work_.out.rect().col_end() == work_.full.cols) {
            gradient_[cols_ + 1] = gradient_[cols_];
        }
        write(work_.plane, row, gradient_.data());
    }

    void write(int plane, int row, const std::uint8_t* values)
    {
        half_way(values, at(row).valid.data() + 1, cols_, least_.data(), most_.data());
        work_.out.write(plane, row, values + 1);
        work_.out.write(plane + 1, row, least_.data());
        work_.out.write(plane + 2, row, most_.data());
    }

    const GradientWork& work_;
    std::size_t cols_;
    ToneRow rows_[kRows];
    Bytes gradient_;
    Bytes least_;
    Bytes most_;
};

void gradient_rows(const GradientWork& work, int row_begin, int row_end)
{
    GradientRows(work).run(row_begin, row_end);
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(gradient_rows);

void gradients(const tiling::Patch<std::uint16_t>& image, tiling::Size full, Tone tone,
               int plane, bool tones, FeaturePlanes& out)
{
    const GradientWork work{image, full, tone, plane, tones, out};
    tbb::parallel_for(tbb::blocked_range<int>(out.rect().row, out.rect().row_end(), 64),
                      [&](const tbb::blocked_range<int>& rows) {
                          HWY_DYNAMIC_DISPATCH(gradient_rows)(work, rows.begin(), rows.end());
                      });
}

} // namespace hsgm::matcher::host
#endif
