#include "matcher/host/prior.h"

#include "matcher/kernel.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/prior.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Entry 2j of `out` becomes that of an even disparity and 2j + 1 that of the odd one above,
// or, beginning with an odd one, the other way round. `q` holds the coarse values, `pairs` and
// one more, and some beyond.
template <bool kOddFirst>
HWY_INLINE void spread(const std::uint8_t* HWY_RESTRICT q, int pairs,
                       std::uint8_t* HWY_RESTRICT out)
{
    const hn::ScalableTag<std::uint16_t> d16;
    const hn::Rebind<std::uint8_t, decltype(d16)> d8;
    const hn::Repartition<std::uint8_t, decltype(d16)> d;
    for (int j = 0; j < pairs; j += static_cast<int>(hn::Lanes(d16))) {
        const auto lower = hn::LoadU(d8, q + j);
        const auto upper = hn::LoadU(d8, q + j + 1);
        const auto odd = hn::PromoteTo(d16, hn::AverageRound(lower, upper));
        const auto even = hn::PromoteTo(d16, kOddFirst ? upper : lower);
        const auto both = kOddFirst ? hn::Or(odd, hn::ShiftLeft<8>(even))
                                    : hn::Or(even, hn::ShiftLeft<8>(odd));
        // Values are at most 16, so no bit crosses from byte to byte but those masked out.
        const auto quarter = hn::And(hn::ShiftRight<2>(both), hn::Set(d16, 0x3F3F));
        hn::StoreU(hn::BitCast(d, quarter), d, out + 2 * j);
    }
}

HWY_INLINE void add(const std::uint8_t* HWY_RESTRICT quarters, int stride,
                    std::uint8_t* HWY_RESTRICT costs)
{
    const hn::CappedTag<std::uint8_t, 16> d;
    for (int i = 0; i < stride; i += static_cast<int>(hn::Lanes(d))) {
        hn::StoreU(hn::SaturatedAdd(hn::LoadU(d, costs + i), hn::LoadU(d, quarters + i)), d,
                   costs + i);
    }
}

void spread_and_add(const PriorPixel& prior, int stride, std::uint8_t* const (&costs)[2],
                    std::uint8_t* q, std::uint8_t* quarters)
{
    // q[j] = value of the coarse disparity first + j, for j = 0..pairs
    const int first = tiling::floor_div(prior.fine.min, 2);
    const int pairs = prior.fine.count() / 2 + 1;
    std::fill_n(q, pairs + 1, std::uint8_t{kPriorCap});
    const int begin = std::max(first, prior.coarse.min);
    const int end = std::min(first + pairs, prior.coarse.max);
    if (begin <= end) {
        std::copy(prior.values + (begin - prior.coarse.min),
                  prior.values + (end - prior.coarse.min) + 1, q + (begin - first));
    }
    if (prior.fine.min == 2 * first) {
        spread<false>(q, pairs, quarters);
    } else {
        spread<true>(q, pairs, quarters);
    }
    for (std::uint8_t* pixel : costs) {
        if (pixel != nullptr) {
            add(quarters, stride, pixel);
        }
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(spread_and_add);

void add_prior(const PriorPixel& prior, int stride, std::uint8_t* const (&costs)[2],
               Buffer<std::uint8_t>& room)
{
    constexpr std::size_t kBeyond = 160; // whole vectors are read and written
    const std::size_t size = static_cast<std::size_t>(stride) + kBeyond;
    std::uint8_t* q = room.need(2 * size);
    HWY_DYNAMIC_DISPATCH(spread_and_add)(prior, stride, costs, q, q + size);
}

} // namespace hsgm::matcher::host
#endif
