#include "matcher/host/census.h"

#include "matcher/pixel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
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
    CensusShape shape;
    FeaturePlanes& out;
};

} // namespace hsgm::matcher::host
#endif

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Vectors may run this far over the end of a row.
constexpr int kSlack = 64;
constexpr int kBitsAPlane = 8;

// Pixels are compared as signed numbers, which every instruction set can. Nodata is then the
// largest one of either width, and darker than nothing.
template <typename T>
T biased(std::uint16_t pixel)
{
    using Unsigned = std::make_unsigned_t<T>;
    constexpr auto kBias = static_cast<Unsigned>(Unsigned{1} << (8 * sizeof(T) - 1));
    return static_cast<T>(static_cast<Unsigned>(pixel) ^ kBias);
}

// Rows of the image, biased and padded at the image's borders: as many as the neighbourhood
// has.
template <typename T>
class PaddedRows {
public:
    explicit PaddedRows(const CensusWork& work)
        : work_(work), count_(2 * work.shape.radius_rows + 1),
          length_(work.out.rect().cols + 2 * work.shape.radius_cols),
          values_(std::size_t(count_) * pitch())
    {
    }

    // The entry of the rectangle's first column.
    const T* row(int row) const { return begin(row) + work_.shape.radius_cols; }

    void load(int row)
    {
        const tiling::Rect& rect = work_.out.rect();
        const int first = rect.col - work_.shape.radius_cols;
        const int begin = std::max(first, 0);
        const int end = std::min(first + length_, work_.full.cols);
        const std::uint16_t* from =
            &work_.image.at(std::clamp(row, 0, work_.full.rows - 1), begin);
        T* to = this->begin(row);
        T* inside = to + (begin - first);
        for (int i = 0; i < end - begin; ++i) {
            inside[i] = biased<T>(from[i]);
        }
        std::fill(to, inside, *inside);
        std::fill(inside + (end - begin), to + length_, inside[end - begin - 1]);
    }

private:
    std::size_t pitch() const { return std::size_t(length_ + kSlack); }
    const T* begin(int row) const
    {
        return values_.data() + std::size_t((row + count_) % count_) * pitch();
    }
    T* begin(int row)
    {
        return values_.data() + std::size_t((row + count_) % count_) * pitch();
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
    for (int k = 0; k < kBitsAPlane; ++k) {
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
        : work_(work), padded_(work), bits_(std::size_t(work.shape.planes() * kBitsAPlane)),
          bytes_(std::size_t(work.out.rect().cols + kSlack))
    {
    }

    void run(int row_begin, int row_end)
    {
        const int radius = work_.shape.radius_rows;
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
        const T* centre = padded_.row(row);
        // Left over bits compare the centre with itself.
        std::fill(bits_.begin(), bits_.end(), Comparison<T>{centre, centre});
        std::size_t bit = 0;
        for (int dr = -work_.shape.radius_rows; dr <= work_.shape.radius_rows; ++dr) {
            for (int dc = -work_.shape.radius_cols; dc <= work_.shape.radius_cols; ++dc) {
                if (dr != 0 || dc != 0) {
                    bits_[bit++].less = padded_.row(row + dr) + dc;
                }
            }
        }
        const auto cols = std::size_t(work_.out.rect().cols);
        for (int plane = 0; plane < work_.shape.planes(); ++plane) {
            compare_row(bits_.data() + plane * kBitsAPlane, cols, bytes_.data());
            work_.out.write(plane, row, bytes_.data());
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

void census(const tiling::Patch<std::uint16_t>& image, tiling::Size full, CensusShape shape,
            FeaturePlanes& out)
{
    const tiling::Rect& rect = out.rect();
    if (rect.empty()) {
        return;
    }
    const CensusWork work{image, full, shape, out};
    const bool narrow = fits_bytes(image.pixels.pixels());
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
