#include "matcher/host/census.h"

#include "matcher/pixel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <type_traits>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/census.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef HSGM_MATCHER_HOST_CENSUS_ONCE
#define HSGM_MATCHER_HOST_CENSUS_ONCE
namespace hsgm::matcher::host {

struct CensusWork {
    const tiling::Patch<std::uint16_t>& image;
    tiling::Size full;
    std::span<const CensusBit> bits;
    int tolerance;
    int radius_rows;
    int radius_cols;
    FeaturePlanes& out;
};

} // namespace hsgm::matcher::host
#endif

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Vectors may run this far over the end of a row.
constexpr int kSlack = 64;
constexpr std::size_t kBitsAPlane = 8;

// Pixels are compared as signed numbers, which every instruction set can.
template <typename T>
T biased(std::uint16_t pixel)
{
    using Unsigned = std::make_unsigned_t<T>;
    constexpr auto kBias = static_cast<Unsigned>(Unsigned{1} << (8 * sizeof(T) - 1));
    return static_cast<T>(static_cast<Unsigned>(pixel) ^ kBias);
}

// Rows of the image, biased and padded at the image's borders, as many as the bits reach: as
// they are compared from below, the tolerance added and nodata the largest number of all, and
// from above, nodata the smallest.
template <typename T>
class PaddedRows {
public:
    explicit PaddedRows(const CensusWork& work)
        : work_(work), count_(2 * work.radius_rows + 1),
          length_(work.out.rect().cols + 2 * work.radius_cols),
          values_(2 * std::size_t(count_) * pitch())
    {
    }

    // The entry of the rectangle's first column.
    const T* less(int row) const { return values_.data() + slot(row) + work_.radius_cols; }
    const T* more(int row) const { return less(row) + pitch(); }

    void load(int row)
    {
        const tiling::Rect& rect = work_.out.rect();
        const int first = rect.col - work_.radius_cols;
        const int begin = std::max(first, 0);
        const int end = std::min(first + length_, work_.full.cols);
        T* less = values_.data() + slot(row);
        T* more = less + pitch();
        convert(&work_.image.at(std::clamp(row, 0, work_.full.rows - 1), begin), end - begin,
                less + (begin - first), more + (begin - first));
        for (T* to : {less, more}) {
            std::fill(to, to + (begin - first), to[begin - first]);
            std::fill(to + (end - first), to + length_, to[end - first - 1]);
        }
    }

private:
    void convert(const std::uint16_t* HWY_RESTRICT pixels, int count, T* HWY_RESTRICT less,
                 T* HWY_RESTRICT more) const
    {
        for (int i = 0; i < count; ++i) {
            less[i] = biased<T>(pixels[i]);
            more[i] = pixels[i] == kNodataPixel ? std::numeric_limits<T>::min() : less[i];
        }
        const hn::ScalableTag<T> d;
        const auto tolerance = hn::Set(d, static_cast<T>(work_.tolerance));
        for (int i = 0; work_.tolerance > 0 && i < count; i += int(hn::Lanes(d))) {
            hn::StoreU(hn::SaturatedAdd(hn::LoadU(d, less + i), tolerance), d, less + i);
        }
    }
    std::size_t pitch() const { return std::size_t(length_ + kSlack); }
    std::size_t slot(int row) const
    {
        return 2 * std::size_t((row + count_) % count_) * pitch();
    }

    const CensusWork& work_;
    int count_;
    int length_;
    std::vector<T> values_;
};

// One bit of a plane: whether entries of one row are less than those of another.
template <typename T>
struct Comparison {
    const T* less;
    const T* more;
};

template <class D, typename T>
HWY_INLINE hn::Vec<D> compare(D d, const Comparison<T>* bits, std::size_t at)
{
    auto byte = hn::Zero(d);
    for (std::size_t k = 0; k < kBitsAPlane; ++k) {
        const auto is_less =
            hn::Lt(hn::LoadU(d, bits[k].less + at), hn::LoadU(d, bits[k].more + at));
        byte = hn::Sub(hn::Add(byte, byte), hn::VecFromMask(d, is_less));
    }
    return byte;
}

HWY_INLINE void compare_row(const Comparison<std::int8_t>* bits, std::size_t cols,
                            std::uint8_t* HWY_RESTRICT out)
{
    const hn::ScalableTag<std::int8_t> d;
    const hn::RebindToUnsigned<decltype(d)> d8;
    for (std::size_t at = 0; at < cols; at += hn::Lanes(d)) {
        hn::StoreU(hn::BitCast(d8, compare(d, bits, at)), d8, out + at);
    }
}

HWY_INLINE void compare_row(const Comparison<std::int16_t>* bits, std::size_t cols,
                            std::uint8_t* HWY_RESTRICT out)
{
    const hn::ScalableTag<std::int16_t> d;
    const hn::Rebind<std::uint8_t, decltype(d)> d8;
    for (std::size_t at = 0; at < cols; at += hn::Lanes(d)) {
        hn::StoreU(hn::DemoteTo(d8, compare(d, bits, at)), d8, out + at);
    }
}

template <typename T>
class CensusRows {
public:
    explicit CensusRows(const CensusWork& work)
        : work_(work), padded_(work),
          bits_((work.bits.size() + kBitsAPlane - 1) / kBitsAPlane * kBitsAPlane),
          bytes_(std::size_t(work.out.rect().cols + kSlack))
    {
    }

    void run(int row_begin, int row_end)
    {
        const int radius = work_.radius_rows;
        for (int row = row_begin - radius; row < row_begin + radius; ++row) {
            padded_.load(row);
        }
        for (int row = row_begin; row < row_end; ++row) {
            padded_.load(row + radius);
            write_bits(row);
        }
    }

private:
    void write_bits(int row)
    {
        // Bits left over compare a row with itself, and stay 0.
        std::fill(bits_.begin(), bits_.end(),
                  Comparison<T>{padded_.less(row), padded_.less(row)});
        for (std::size_t i = 0; i < work_.bits.size(); ++i) {
            const CensusBit& bit = work_.bits[i];
            bits_[i] = {padded_.less(row + bit.less.row) + bit.less.col,
                        padded_.more(row + bit.more.row) + bit.more.col};
        }
        const auto cols = std::size_t(work_.out.rect().cols);
        for (std::size_t i = 0; i < bits_.size(); i += kBitsAPlane) {
            compare_row(bits_.data() + i, cols, bytes_.data());
            work_.out.write(static_cast<int>(i / kBitsAPlane), row, bytes_.data());
        }
    }

    const CensusWork& work_;
    PaddedRows<T> padded_;
    std::vector<Comparison<T>> bits_;
    std::vector<std::uint8_t> bytes_;
};

void census_rows_of_bytes(const CensusWork& work, int row_begin, int row_end)
{
    CensusRows<std::int8_t>(work).run(row_begin, row_end);
}

void census_rows_of_words(const CensusWork& work, int row_begin, int row_end)
{
    CensusRows<std::int16_t>(work).run(row_begin, row_end);
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

namespace {

HWY_EXPORT(census_rows_of_bytes);
HWY_EXPORT(census_rows_of_words);

// Whether all valid pixels are below 256: then bytes do, twice as many in a vector.
bool fits_bytes(std::span<const std::uint16_t> pixels)
{
    std::uint16_t bits = 0;
    for (const std::uint16_t pixel : pixels) {
        bits |= pixel == kNodataPixel ? std::uint16_t{0} : pixel;
    }
    return bits < 256;
}

} // namespace

void census(const tiling::Patch<std::uint16_t>& image, tiling::Size full,
            std::span<const CensusBit> bits, int tolerance, FeaturePlanes& out)
{
    const tiling::Rect& rect = out.rect();
    CensusWork work{image, full, bits, tolerance, 0, 0, out};
    for (const CensusBit& bit : bits) {
        for (const Offset offset : {bit.less, bit.more}) {
            work.radius_rows = std::max(work.radius_rows, std::abs(offset.row));
            work.radius_cols = std::max(work.radius_cols, std::abs(offset.col));
        }
    }
    const bool narrow = tolerance < 128 && fits_bytes(image.pixels.pixels());
    tbb::parallel_for(
        tbb::blocked_range<int>(rect.row, rect.row_end(), 64),
        [&](const tbb::blocked_range<int>& rows) {
            if (narrow) {
                HWY_DYNAMIC_DISPATCH(census_rows_of_bytes)(work, rows.begin(), rows.end());
            } else {
                HWY_DYNAMIC_DISPATCH(census_rows_of_words)(work, rows.begin(), rows.end());
            }
        });
}

} // namespace hsgm::matcher::host
#endif
