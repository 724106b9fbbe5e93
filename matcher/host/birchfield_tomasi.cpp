#include "matcher/host/birchfield_tomasi.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/birchfield_tomasi.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After Highway: compiled once for every target.
#include "matcher/host/cost_row-inl.h"
#include "matcher/host/sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

// The difference of one pair of pixels: twice that of gradients, and a quarter of that of
// tones.
class Difference {
public:
    explicit Difference(const CostRow& row) : row_(row) {}

    template <int kVectors, class D, class Writer>
    HWY_INLINE void vectors(D d, int pixel, std::size_t first, std::size_t at,
                            const Writer& writer) const
    {
        const std::uint8_t* right = row_.right + first;
        const Sample<D> gradient(d, row_.left + pixel, row_.left_pitch);
        const Sample<D> tone(d, row_.left + pixel + 3 * row_.left_pitch, row_.left_pitch);
        for (int k = 0; k < kVectors; ++k, at += hn::Lanes(d)) {
            const auto of_tones =
                tone.difference(d, right + at + 3 * row_.right_pitch, row_.right_pitch);
            const auto of_gradients = gradient.difference(d, right + at, row_.right_pitch);
            const auto sum =
                hn::Add(hn::Add(of_gradients, of_gradients), hn::ShiftRight<2>(of_tones));
            writer.write(d, at, hn::Min(sum, hn::Set(d, std::uint8_t{kMostDifference})));
        }
    }

private:
    const CostRow& row_;
};

HWY_INLINE void add_three(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c,
                          std::ptrdiff_t count, std::uint8_t* HWY_RESTRICT sums)
{
    const hn::CappedTag<std::uint8_t, 16> d16;
    const hn::ScalableTag<std::uint8_t> d;
    const auto step = static_cast<std::ptrdiff_t>(hn::Lanes(d));
    std::ptrdiff_t i = 0;
    for (; i + step <= count; i += step) {
        const auto two = hn::Add(hn::LoadU(d, a + i), hn::LoadU(d, b + i));
        hn::StoreU(hn::Add(two, hn::LoadU(d, c + i)), d, sums + i);
    }
    for (; i < count; i += 16) {
        const auto two = hn::Add(hn::LoadU(d16, a + i), hn::LoadU(d16, b + i));
        hn::StoreU(hn::Add(two, hn::LoadU(d16, c + i)), d16, sums + i);
    }
}

void sum_row(const CostRow& row, int before, int after, std::uint8_t* differences,
             std::uint8_t* sums)
{
    fill_row(row, Difference(row), differences);
    const std::ptrdiff_t stride = row.stride;
    const int count = row.cols - before - after;
    const std::uint8_t* here = differences + before * stride;
    // The neighbours of the image's first and last column are these themselves.
    const int first = before == 0 ? 1 : 0;
    const int last = after == 0 ? count - 1 : count;
    if (first == 1) {
        add_three(here, here, count == 1 && after == 0 ? here : here + stride, stride, sums);
    }
    if (first < last) {
        add_three(here + (first - 1) * stride, here + first * stride,
                  here + (first + 1) * stride, (last - first) * stride, sums + first * stride);
    }
    if (last < count && last >= first) {
        const std::uint8_t* end = here + last * stride;
        add_three(end - stride, end, end, stride, sums + last * stride);
    }
}

// A quarter of the sum over nine pixels.
class BlockKernel {
public:
    BlockKernel(const std::uint8_t* const (&sums)[3], const CostRow& row)
        : sums_(sums), stride_(std::size_t(row.stride))
    {
    }

    template <int kVectors, class D, class Writer>
    HWY_INLINE void vectors(D d, int pixel, std::size_t, std::size_t at,
                            const Writer& writer) const
    {
        const std::size_t start = std::size_t(pixel) * stride_;
        for (int k = 0; k < kVectors; ++k, at += hn::Lanes(d)) {
            const auto two = hn::Add(hn::LoadU(d, sums_[0] + start + at),
                                     hn::LoadU(d, sums_[1] + start + at));
            const auto sum = hn::Add(two, hn::LoadU(d, sums_[2] + start + at));
            writer.write(d, at, hn::ShiftRight<2>(sum));
        }
    }

private:
    const std::uint8_t* const (&sums_)[3];
    std::size_t stride_;
};

void block_row(const std::uint8_t* const (&sums)[3], const CostRow& row, std::uint8_t* costs)
{
    fill_row(row, BlockKernel(sums, row), costs);
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(sum_row);
HWY_EXPORT(block_row);

void difference_sums(const CostRow& row, int before, int after, std::uint8_t* differences,
                     std::uint8_t* sums)
{
    HWY_DYNAMIC_DISPATCH(sum_row)(row, before, after, differences, sums);
}

void block_costs(const std::uint8_t* const (&sums)[3], const CostRow& row, std::uint8_t* costs)
{
    HWY_DYNAMIC_DISPATCH(block_row)(sums, row, costs);
}

} // namespace hsgm::matcher::host
#endif
