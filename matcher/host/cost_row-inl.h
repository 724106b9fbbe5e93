// How costs of a row are filled in, whatever the cost: the loop over pixels and vectors, and
// what becomes of nodata and padding. Compiled once for every instruction set: the guard below
// is Highway's, which lets each of its targets include this file again.
#if defined(HSGM_MATCHER_HOST_COST_ROW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HSGM_MATCHER_HOST_COST_ROW_INL_H_
#undef HSGM_MATCHER_HOST_COST_ROW_INL_H_
#else
#define HSGM_MATCHER_HOST_COST_ROW_INL_H_
#endif

#include "matcher/host/cost_row.h"

#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Where the costs of one vector of disparities go.
template <bool kPlain>
class CostWriter {
public:
    CostWriter(const CostRow& row, std::size_t first, std::uint8_t* costs)
        : valid_(row.right_valid + first), padding_(row.padding), costs_(costs), half_(row.half)
    {
    }

    template <class D>
    HWY_INLINE void write(D d, std::size_t at, hn::Vec<D> cost) const
    {
        if constexpr (!kPlain) {
            const auto none = hn::Eq(hn::LoadU(d, valid_ + at), hn::Zero(d));
            cost = hn::Or(hn::IfThenElse(none, hn::Set(d, half_), cost),
                          hn::LoadU(d, padding_ + at));
        }
        hn::StoreU(cost, d, costs_ + at);
    }

private:
    const std::uint8_t* valid_;
    const std::uint8_t* padding_;
    std::uint8_t* HWY_RESTRICT costs_;
    std::uint8_t half_;
};

// Vectors of one length from `at` on, several at once as long as that goes.
template <class D, class Kernel, class Writer>
HWY_INLINE std::size_t fill_vectors(D d, const Kernel& kernel, int pixel, std::size_t first,
                                    std::size_t at, std::size_t end, const Writer& writer)
{
    const std::size_t lanes = hn::Lanes(d);
    for (; at + 4 * lanes <= end; at += 4 * lanes) {
        kernel.template vectors<4>(d, pixel, first, at, writer);
    }
    if (at + 2 * lanes <= end) {
        kernel.template vectors<2>(d, pixel, first, at, writer);
        at += 2 * lanes;
    }
    if (at + lanes <= end) {
        kernel.template vectors<1>(d, pixel, first, at, writer);
        at += lanes;
    }
    return at;
}

// `kernel.vectors<n>(d, pixel, first, at, writer)` writes n vectors from disparity number
// `at` on, of the left pixel whose right entries start at `first`.
template <bool kPlain, class Kernel>
HWY_INLINE void fill_row(const CostRow& row, const Kernel& kernel, std::uint8_t* costs)
{
    const auto end = static_cast<std::size_t>(row.stride);
    for (int i = 0; i < row.cols; ++i, costs += row.stride) {
        if (row.left_valid[i] == 0) {
            std::fill_n(costs, row.count, row.half);
            std::fill(costs + row.count, costs + row.stride, std::uint8_t{255});
            continue;
        }
        const auto first = static_cast<std::size_t>(row.cols - 1 - i);
        const CostWriter<kPlain> writer(row, first, costs);
        const hn::CappedTag<std::uint8_t, 64> d64;
        const hn::CappedTag<std::uint8_t, 32> d32;
        const hn::CappedTag<std::uint8_t, 16> d16;
        std::size_t at = fill_vectors(d64, kernel, i, first, 0, end, writer);
        if constexpr (hn::MaxLanes(d64) > 32) {
            at = fill_vectors(d32, kernel, i, first, at, end, writer);
        }
        if constexpr (hn::MaxLanes(d64) > 16) {
            fill_vectors(d16, kernel, i, first, at, end, writer);
        }
    }
}

template <class Kernel>
HWY_INLINE void fill_row(const CostRow& row, const Kernel& kernel, std::uint8_t* costs)
{
    if (row.plain) {
        fill_row<true>(row, kernel, costs);
    } else {
        fill_row<false>(row, kernel, costs);
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
