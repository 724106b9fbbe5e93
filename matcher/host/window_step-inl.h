// The vector steps of a window's paths (8-bit costs), compiled once for every instruction
// set: the guard below is Highway's, which lets each of its targets include this file again.
#if defined(HSGM_MATCHER_HOST_WINDOW_STEP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef HSGM_MATCHER_HOST_WINDOW_STEP_INL_H_
#undef HSGM_MATCHER_HOST_WINDOW_STEP_INL_H_
#else
#define HSGM_MATCHER_HOST_WINDOW_STEP_INL_H_
#endif

#include "matcher/host/sweep_step-inl.h"
#include "tiling/disparity_range.h"
#include "tiling/rect.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Bytes between the costs of two pixels, so that d-1 of the first and d+1 of the last
// disparity read "infinitely dear".
constexpr std::size_t kSlotGuard = 16;
// Whole vectors are read and written at the end of a buffer.
constexpr std::size_t kReadBeyond = 64;

// Where one path stands in a row: its costs (replaced in place), their least, P2'.
struct StepPath {
    std::uint8_t* values = nullptr;
    std::uint8_t* least = nullptr;
    const std::uint8_t* p2 = nullptr;
};

// `kVectors` vectors of kLanes hold a pixel's costs; 0: any number.
template <int kLanes, int kVectors>
class WindowStep {
    using D = hn::CappedTag<std::uint8_t, kLanes>;
    using D16 = hn::Repartition<std::uint16_t, D>;
    using V = hn::Vec<D>;
    using V16 = hn::Vec<D16>;
    static constexpr int kN = int(hn::MaxLanes(D()));

public:
    WindowStep(int stride, int p1)
        : stride_(stride), vectors_(kVectors > 0 ? kVectors : stride / kN),
          p1_(hn::Set(D(), static_cast<std::uint8_t>(p1)))
    {
    }

    // Eq. 1 for one pixel; `now` may be `before`. Returns the least new cost.
    HWY_INLINE std::uint8_t follow(const std::uint8_t* before, std::uint8_t before_least,
                                   std::uint8_t p2, const std::uint8_t* costs,
                                   std::uint8_t* now) const
    {
        return step(before, before_least, p2, costs, now, [](int, V) HWY_ATTR {});
    }

    // Eq. 1 for `count` paths at one pixel, and the sums of these and the path along the row.
    // Moves the paths on to the pixel to the right.
    template <bool kFirst>
    HWY_INLINE void sum(const std::uint8_t* along, StepPath* paths, int count,
                        std::size_t pitch, const std::uint8_t* costs,
                        std::uint16_t* sums) const
    {
        if constexpr (kVectors > 0) {
            sum_in_registers<kFirst>(along, paths, count, pitch, costs, sums);
        } else {
            sum_in_memory<kFirst>(along, paths, count, pitch, costs, sums);
        }
    }

private:
    template <class Out>
    HWY_INLINE std::uint8_t step(const std::uint8_t* before, std::uint8_t before_least,
                                 std::uint8_t p2, const std::uint8_t* HWY_RESTRICT costs,
                                 std::uint8_t* now, Out out) const
    {
        const D d;
        const auto least = hn::Set(d, before_least);
        // Saturated: where a path starts in disparities the coarser level never searched,
        // even the least cost may be dear.
        const auto jump = hn::SaturatedAdd(least, hn::Set(d, p2));
        auto minimum = hn::Set(d, std::uint8_t{255});
        auto below = hn::LoadU(d, before - 1);
        for (int v = 0; v < vectors(); ++v) {
            const int i = v * kN;
            const auto same = hn::LoadU(d, before + i);
            const auto above = hn::LoadU(d, before + i + 1);
            const auto aside = hn::SaturatedAdd(hn::Min(below, above), p1_);
            // Read before `now`, which may lie over it, is written.
            below = hn::LoadU(d, before + i + kN - 1);
            const auto best = hn::Min(hn::Min(same, jump), aside);
            const auto path =
                hn::SaturatedAdd(hn::LoadU(d, costs + i), hn::Sub(best, least));
            hn::StoreU(path, d, now + i);
            minimum = hn::Min(minimum, path);
            out(v, path);
        }
        return least_lane(d, minimum);
    }

    template <bool kFirst>
    HWY_INLINE void sum_in_registers(const std::uint8_t* along, StepPath* paths, int count,
                                     std::size_t pitch, const std::uint8_t* costs,
                                     std::uint16_t* sums) const
    {
        // Of 16-bit lanes that hold two costs each: their sum, and the sum of the high ones.
        const D16 d16;
        V16 pairs[kVectors == 0 ? 1 : kVectors];
        V16 highs[kVectors == 0 ? 1 : kVectors];
        for (int v = 0; v < kVectors; ++v) {
            pairs[v] = hn::BitCast(d16, hn::LoadU(D(), along + v * kN));
            highs[v] = hn::ShiftRight<8>(pairs[v]);
        }
        for (int k = 0; k < count; ++k) {
            StepPath& path = paths[k];
            *path.least = step(path.values, *path.least, *path.p2, costs, path.values,
                               [&](int v, V costs_now) HWY_ATTR {
                                   const auto pair = hn::BitCast(d16, costs_now);
                                   pairs[v] = hn::Add(pairs[v], pair);
                                   highs[v] = hn::Add(highs[v], hn::ShiftRight<8>(pair));
                               });
            path.values += pitch;
            ++path.least;
            ++path.p2;
        }
        std::uint16_t* odd_sums = sums + stride_ / 2;
        for (int v = 0; v < kVectors; ++v) {
            const int i = v * (kN / 2);
            put<kFirst>(hn::Sub(pairs[v], hn::ShiftLeft<8>(highs[v])), sums + i);
            put<kFirst>(highs[v], odd_sums + i);
        }
    }
    template <bool kFirst>
    HWY_INLINE void put(V16 value, std::uint16_t* sums) const
    {
        const D16 d16;
        hn::StoreU(kFirst ? value : hn::Add(hn::LoadU(d16, sums), value), d16, sums);
    }

    template <bool kFirst>
    HWY_INLINE void sum_in_memory(const std::uint8_t* along, StepPath* paths, int count,
                                  std::size_t pitch, const std::uint8_t* costs,
                                  std::uint16_t* sums) const
    {
        const D d;
        for (int i = 0; i < stride_; i += kN) {
            add_to_sums(d, hn::LoadU(d, along + i), i, stride_, sums, kFirst);
        }
        for (int k = 0; k < count; ++k) {
            StepPath& path = paths[k];
            *path.least = step(path.values, *path.least, *path.p2, costs, path.values,
                               [&](int v, V costs_now) HWY_ATTR {
                                   add_to_sums(D(), costs_now, v * kN, stride_, sums, false);
                               });
            path.values += pitch;
            ++path.least;
            ++path.p2;
        }
    }

    HWY_INLINE int vectors() const { return kVectors > 0 ? kVectors : vectors_; }

    int stride_;
    int vectors_;
    V p1_;
};

// Where a path enters a window: the coarser level's costs `kept`, of the disparities
// `coarse`, for the disparities `fine` (docs/algorithm.md, "Coarse start"), padded with 255
// up to `stride`. Returns the least. `scratch` holds 2 * stride + 256 bytes.
HWY_INLINE std::uint8_t spread_start(const std::uint8_t* kept, tiling::DisparityRange coarse,
                                     tiling::DisparityRange fine, std::uint8_t unsearched,
                                     int stride, std::uint8_t* scratch, std::uint8_t* out)
{
    const hn::FixedTag<std::uint8_t, 16> d;
    const int count = fine.count();
    const int first = tiling::floor_div(fine.min, 2);
    const int values = count / 2 + 2;
    // scratch[j]: the cost of coarse disparity first + j.
    for (int j = 0; j < values; j += 16) {
        hn::StoreU(hn::Set(d, unsearched), d, scratch + j);
    }
    const int begin = std::max(first, coarse.min);
    const int end = std::min(first + values, coarse.max + 1);
    if (begin < end) {
        std::memcpy(scratch + (begin - first), kept + (begin - coarse.min),
                    std::size_t(end - begin));
    }
    std::uint8_t* spread = scratch + stride / 2 + 96;
    for (int j = 0; j < values; j += 16) {
        const auto even = hn::LoadU(d, scratch + j);
        const auto odd = hn::AverageRound(even, hn::LoadU(d, scratch + j + 1));
        hn::StoreU(hn::InterleaveLower(d, even, odd), d, spread + 2 * j);
        hn::StoreU(hn::InterleaveUpper(d, even, odd), d, spread + 2 * j + 16);
    }
    spread += fine.min - 2 * first;
    std::memset(spread + count, 255, std::size_t(stride - count));
    auto least = hn::Set(d, std::uint8_t{255});
    for (int i = 0; i < stride; i += 16) {
        const auto v = hn::LoadU(d, spread + i);
        least = hn::Min(least, v);
        hn::StoreU(v, d, out + i);
    }
    return least_lane(d, least);
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
