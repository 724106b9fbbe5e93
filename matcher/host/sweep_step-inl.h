// One step of a path in vectors (eq. 1), compiled once for every instruction set: the guard
// below is Highway's, which lets each of its targets include this file again.
#if defined(HSGM_MATCHER_HOST_SWEEP_STEP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HSGM_MATCHER_HOST_SWEEP_STEP_INL_H_
#undef HSGM_MATCHER_HOST_SWEEP_STEP_INL_H_
#else
#define HSGM_MATCHER_HOST_SWEEP_STEP_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Path costs of neighbouring pixels are stored one guard apart, so that d-1 of the first and
// d+1 of the last disparity read the guard: infinitely dear.
constexpr std::size_t kGuard = 16;

template <typename L>
constexpr L kInfinite = std::numeric_limits<L>::max();

// Adds the L of one vector, lanes i.. of a pixel, to its sums (laid out as in sums.h).
template <class D, class V>
HWY_INLINE void add_to_sums(D, V path, int i, int stride, std::uint16_t* HWY_RESTRICT sums,
                            bool first)
{
    using L = hn::TFromD<D>;
    std::uint16_t* even_sums = sums + i / 2;
    std::uint16_t* odd_sums = even_sums + stride / 2;
    const auto put = [&](auto d16, auto even, auto odd) HWY_ATTR {
        if (!first) {
            even = hn::SaturatedAdd(hn::LoadU(d16, even_sums), even);
            odd = hn::SaturatedAdd(hn::LoadU(d16, odd_sums), odd);
        }
        hn::StoreU(even, d16, even_sums);
        hn::StoreU(odd, d16, odd_sums);
    };
    if constexpr (sizeof(L) == 1) {
        const hn::Repartition<std::uint16_t, D> d16;
        const auto pairs = hn::BitCast(d16, path);
        put(d16, hn::And(pairs, hn::Set(d16, std::uint16_t{0xFF})), hn::ShiftRight<8>(pairs));
    } else {
        const hn::RepartitionToWide<D> d32;
        const hn::Rebind<std::uint16_t, decltype(d32)> d16;
        const auto pairs = hn::BitCast(d32, path);
        put(d16, hn::TruncateTo(d16, hn::And(pairs, hn::Set(d32, 0xFFFFU))),
            hn::TruncateTo(d16, hn::ShiftRight<16>(pairs)));
    }
}

// The least of eight (or fewer) 16-bit lanes. Where one instruction finds it, Highway 1.0
// would spread it over all lanes before one is read.
template <class V>
HWY_INLINE std::uint16_t least_of_eight(V v)
{
#if HWY_TARGET <= HWY_SSE4
    if constexpr (sizeof(v) == 16 && hn::MaxLanes(hn::DFromV<V>()) == 8) {
        return static_cast<std::uint16_t>(_mm_cvtsi128_si32(_mm_minpos_epu16(v.raw)));
    }
#endif
    return hn::GetLane(hn::MinOfLanes(hn::DFromV<V>(), v));
}

// Folds a vector to 128 bits, pairs of bytes to 16-bit lanes, and asks for their minimum,
// which is one instruction there.
template <class D>
HWY_INLINE hn::TFromD<D> least_lane(D d, hn::Vec<D> v)
{
    using L = hn::TFromD<D>;
    if constexpr (sizeof(L) * hn::MaxLanes(d) > 16) {
        const hn::Half<D> half;
        return least_lane(half, hn::Min(hn::UpperHalf(half, v), hn::LowerHalf(half, v)));
    } else {
        const hn::RepartitionToWide<hn::CappedTag<std::uint8_t, 16>> d16;
        if constexpr (sizeof(L) == 1) {
            const auto pairs = hn::BitCast(d16, v);
            const auto low = hn::And(pairs, hn::Set(d16, 0xFF));
            return static_cast<L>(least_of_eight(hn::Min(low, hn::ShiftRight<8>(pairs))));
        } else {
            return least_of_eight(v);
        }
    }
}

template <class D>
HWY_INLINE auto load_costs(D d, const std::uint8_t* costs)
{
    using L = hn::TFromD<D>;
    if constexpr (sizeof(L) == 1) {
        return hn::LoadU(d, costs);
    } else {
        // The padding 255 has to become infinite in 16 bits too.
        const hn::Rebind<std::uint8_t, D> d8;
        const auto wide = hn::PromoteTo(d, hn::LoadU(d8, costs));
        return hn::IfThenElse(hn::Eq(wide, hn::Set(d, L{255})), hn::Set(d, kInfinite<L>), wide);
    }
}

template <int kLanes, typename L>
struct Step {
    using D = hn::CappedTag<L, kLanes>;

    // Eq. 1 for one pixel. `before` are the predecessor's path costs, with readable guards
    // on both sides; returns the least new cost.
    static HWY_INLINE L follow(const L* HWY_RESTRICT before, L before_least,
                               const std::uint8_t* HWY_RESTRICT costs, int stride, int p1,
                               int p2, L* HWY_RESTRICT now, std::uint16_t* HWY_RESTRICT sums,
                               bool first)
    {
        const D d;
        const auto penalty1 = hn::Set(d, static_cast<L>(p1));
        const auto least = hn::Set(d, before_least);
        const auto jump =
            hn::Set(d, static_cast<L>(std::min<int>(before_least + p2, kInfinite<L>)));
        auto minimum = hn::Set(d, kInfinite<L>);
        for (int i = 0; i < stride; i += static_cast<int>(hn::Lanes(d))) {
            const auto same = hn::LoadU(d, before + i);
            const auto aside =
                hn::Min(hn::LoadU(d, before + i - 1), hn::LoadU(d, before + i + 1));
            const auto best = hn::Min(hn::Min(same, jump), hn::SaturatedAdd(aside, penalty1));
            const auto path =
                hn::SaturatedAdd(load_costs(d, costs + i), hn::SaturatedSub(best, least));
            hn::StoreU(path, d, now + i);
            minimum = hn::Min(minimum, path);
            if (sums != nullptr) {
                add_to_sums(d, path, i, stride, sums, first);
            }
        }
        return least_lane(d, minimum);
    }

    // L = C, where a path begins.
    static HWY_INLINE L begin(const std::uint8_t* HWY_RESTRICT costs, int stride,
                              L* HWY_RESTRICT now, std::uint16_t* HWY_RESTRICT sums, bool first)
    {
        const D d;
        auto minimum = hn::Set(d, kInfinite<L>);
        for (int i = 0; i < stride; i += static_cast<int>(hn::Lanes(d))) {
            const auto path = load_costs(d, costs + i);
            hn::StoreU(path, d, now + i);
            minimum = hn::Min(minimum, path);
            if (sums != nullptr) {
                add_to_sums(d, path, i, stride, sums, first);
            }
        }
        return least_lane(d, minimum);
    }

private:
};

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
