#include "matcher/host/sum_results.h"

#include "matcher/host/sums.h"
#include "matcher/kernel.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/sum_results.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;

// floor(p / q) for whole numbers 0 <= p < 2^24, 1 <= q < 2^16 with a quotient of at most 256:
// p and q are exact as floats, and p / q differs from the next whole number by more than a
// float is rounded there. So this is the division of integers, but several at once.
template <class V>
HWY_INLINE hn::Vec<Ints> quotient(V p, V q)
{
    return hn::ConvertTo(Ints(), hn::Div(p, q));
}

// `subpixel_q8` without its integer part, from S(d-1) - S(d) and S(d+1) - S(d).
template <class V>
HWY_INLINE hn::Vec<Ints> offset_of(V a, V b)
{
    const Floats d;
    const Ints di;
    const auto most = hn::Max(a, b);
    const auto x =
        quotient(hn::Mul(hn::Set(d, 256.0F), hn::Min(a, b)), hn::Max(most, hn::Set(d, 1.0F)));
    const auto bend = hn::ShiftRight<10>(hn::Mul(x, hn::Add(x, hn::Set(di, 256))));
    const auto offset = hn::Sub(hn::Set(di, 128), bend);
    const auto below = hn::Neg(hn::Min(offset, hn::Set(di, 127)));
    const auto signed_offset = hn::IfThenElse(hn::RebindMask(di, hn::Lt(a, b)), below, offset);
    return hn::IfThenElseZero(hn::RebindMask(di, hn::Gt(most, hn::Zero(d))), signed_offset);
}

// `confidence_of`; 255 where the rival is negative, which stands for none.
template <class V>
HWY_INLINE hn::Vec<Ints> confidence(V least, V rival)
{
    const Floats d;
    const Ints di;
    const auto c = quotient(hn::Mul(hn::Set(d, 255.0F), hn::Sub(rival, least)),
                            hn::Max(rival, hn::Set(d, 1.0F)));
    const auto alone = hn::RebindMask(di, hn::Lt(rival, hn::Zero(d)));
    return hn::IfThenElse(alone, hn::Set(di, 255), hn::Max(c, hn::Set(di, 1)));
}

// Results of whole vectors; returns how many pixels those are.
int results(const SumRelations& sums, int cols, std::int32_t* disparity_q8,
            std::uint8_t* confidences)
{
    const Floats d;
    const Ints di;
    const hn::Rebind<std::uint8_t, Floats> d8;
    const int lanes = static_cast<int>(hn::Lanes(d));
    int i = 0;
    for (; i + lanes <= cols; i += lanes) {
        const auto a = hn::LoadU(d, sums.below + i);
        const auto b = hn::LoadU(d, sums.above + i);
        const auto winner = hn::LoadU(di, disparity_q8 + i);
        hn::StoreU(hn::Add(winner, offset_of(a, b)), di, disparity_q8 + i);
        const auto c = confidence(hn::LoadU(d, sums.least + i), hn::LoadU(d, sums.rival + i));
        hn::StoreU(hn::DemoteTo(d8, c), d8, confidences + i);
    }
    return i;
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(results);

void sum_results(const SumsRow& row, const Winner* winners, int range_min,
                 Buffer<float>& workspace, std::int32_t* disparity_q8, std::uint8_t* confidence)
{
    const auto cols = static_cast<std::size_t>(row.cols);
    float* values = workspace.need(4 * cols);
    const SumRelations sums{values, values + cols, values + 2 * cols, values + 3 * cols};
    for (int i = 0; i < row.cols; ++i) {
        const Winner& w = winners[i];
        const std::uint16_t* at = row.at(i);
        const bool inner = w.index > 0 && w.index + 1 < row.count;
        // Without two neighbours both are 0, which leaves the winner as it is.
        sums.below[i] =
            static_cast<float>(inner ? sum_at(at, row.stride, w.index - 1) - w.sum : 0);
        sums.above[i] =
            static_cast<float>(inner ? sum_at(at, row.stride, w.index + 1) - w.sum : 0);
        sums.least[i] = static_cast<float>(w.sum);
        sums.rival[i] = static_cast<float>(w.rival);
        disparity_q8[i] = 256 * (range_min + w.index);
    }
    int i = HWY_DYNAMIC_DISPATCH(results)(sums, row.cols, disparity_q8, confidence);
    for (; i < row.cols; ++i) {
        const Winner& w = winners[i];
        disparity_q8[i] = subpixel_q8(range_min + w.index, static_cast<int>(sums.below[i]), 0,
                                      static_cast<int>(sums.above[i]));
        confidence[i] =
            static_cast<std::uint8_t>(w.rival < 0 ? 255 : confidence_of(w.sum, w.rival));
    }
}

} // namespace hsgm::matcher::host
#endif
