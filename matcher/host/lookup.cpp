#include "matcher/host/lookup.h"

// Lookups in tables of 128 bytes are worth a target of their own.
#define HWY_WANT_AVX3_DL
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/lookup.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After Highway: compiled once for every target.
#include "matcher/host/cost_row-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

#if HWY_TARGET == HWY_AVX3_DL

// The entries `index` of 256 bytes. Two instructions look up 7 bits of an index each, in either
// half of the table; the eighth chooses.
HWY_INLINE __m512i entries(const std::uint8_t* table, __m512i index)
{
    const __m512i low = _mm512_permutex2var_epi8(_mm512_loadu_si512(table), index,
                                                 _mm512_loadu_si512(table + 64));
    const __m512i high = _mm512_permutex2var_epi8(_mm512_loadu_si512(table + 128), index,
                                                  _mm512_loadu_si512(table + 192));
    return _mm512_mask_blend_epi8(_mm512_movepi8_mask(index), low, high);
}

template <class D>
HWY_INLINE hn::Vec<D> look_up(D d, const std::uint8_t* table, hn::Vec<D> index)
{
    if constexpr (hn::MaxLanes(d) == 64) {
        return hn::Vec<D>{entries(table, index.raw)};
    } else if constexpr (hn::MaxLanes(d) == 32) {
        return hn::Vec<D>{
            _mm512_castsi512_si256(entries(table, _mm512_castsi256_si512(index.raw)))};
    } else {
        return hn::Vec<D>{
            _mm512_castsi512_si128(entries(table, _mm512_castsi128_si512(index.raw)))};
    }
}

#else

// The entries `index` of 256 bytes: looked up in each sixteenth of the table by the low bits
// of the index, of which the high bits then choose, pair by pair.
template <class D>
class Chooser {
public:
    using V = hn::Vec<D>;

    Chooser(D d, V index)
        : low_(hn::And(index, hn::Set(d, std::uint8_t{15}))),
          bit4_(hn::TestBit(index, hn::Set(d, std::uint8_t{16}))),
          bit5_(hn::TestBit(index, hn::Set(d, std::uint8_t{32}))),
          bit6_(hn::TestBit(index, hn::Set(d, std::uint8_t{64}))),
          bit7_(hn::TestBit(index, hn::Set(d, std::uint8_t{128})))
    {
    }
    HWY_INLINE V of_256(D d, const std::uint8_t* table) const
    {
        return hn::IfThenElse(bit7_, of_128(d, table + 128), of_128(d, table));
    }

private:
    HWY_INLINE V of_128(D d, const std::uint8_t* table) const
    {
        return hn::IfThenElse(bit6_, of_64(d, table + 64), of_64(d, table));
    }
    HWY_INLINE V of_64(D d, const std::uint8_t* table) const
    {
        return hn::IfThenElse(bit5_, of_32(d, table + 32), of_32(d, table));
    }
    HWY_INLINE V of_32(D d, const std::uint8_t* table) const
    {
        return hn::IfThenElse(bit4_, hn::TableLookupBytes(hn::LoadDup128(d, table + 16), low_),
                              hn::TableLookupBytes(hn::LoadDup128(d, table), low_));
    }

    V low_;
    hn::Mask<D> bit4_;
    hn::Mask<D> bit5_;
    hn::Mask<D> bit6_;
    hn::Mask<D> bit7_;
};

template <class D>
HWY_INLINE hn::Vec<D> look_up(D d, const std::uint8_t* table, hn::Vec<D> index)
{
    return Chooser<D>(d, index).of_256(d, table);
}

#endif

class TableKernel {
public:
    TableKernel(const HmiTable& table, const CostRow& row)
        : table_(table.cost.data()), left_(row.left), right_(row.right)
    {
    }

    template <int kVectors, class D, class Writer>
    HWY_INLINE void vectors(D d, int pixel, std::size_t first, std::size_t at,
                            const Writer& writer) const
    {
        const std::uint8_t* costs = table_ + std::size_t{left_[pixel]} * 256;
        for (int k = 0; k < kVectors; ++k, at += hn::Lanes(d)) {
            writer.write(d, at, look_up(d, costs, hn::LoadU(d, right_ + first + at)));
        }
    }

private:
    const std::uint8_t* table_;
    const std::uint8_t* left_;
    const std::uint8_t* right_;
};

void lookup_row(const HmiTable& table, const CostRow& row, std::uint8_t* costs)
{
    fill_row(row, TableKernel(table, row), costs);
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(lookup_row);

void lookup_costs(const HmiTable& table, const CostRow& row, std::uint8_t* costs)
{
    HWY_DYNAMIC_DISPATCH(lookup_row)(table, row, costs);
}

} // namespace hsgm::matcher::host
#endif
