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

// A row of a window's core: the path along it, done already, and what the others need.
struct SumRow {
    const std::uint8_t* along = nullptr;
    std::ptrdiff_t along_step = 0;
    std::size_t pitch = 0;
    const std::uint8_t* costs = nullptr;
    std::uint16_t* sums = nullptr;
    int cols = 0;
};

// Takes the path costs of a halo, where nothing is summed.
template <class V>
struct NoSums {
    template <int>
    HWY_INLINE void add(V)
    {
    }
};

// Sums of up to four vectors of a pixel's costs, in registers: of 16-bit lanes that hold two
// costs each, the sum of both and the sum of the high ones.
template <class D, int kVectors>
class RegisterSums {
    using D16 = hn::Repartition<std::uint16_t, D>;
    static constexpr int kN = int(hn::MaxLanes(D()));

public:
    HWY_INLINE explicit RegisterSums(const std::uint8_t* first) { start<0>(first); }

    template <int kVector>
    HWY_INLINE void add(hn::Vec<D> costs)
    {
        const auto pair = hn::BitCast(D16(), costs);
        pairs_[kVector] = hn::Add(pairs_[kVector], pair);
        highs_[kVector] = hn::Add(highs_[kVector], hn::ShiftRight<8>(pair));
    }

    // Stores the sums (laid out as in sums.h), or adds them to those there.
    template <bool kStore, int kVector = 0>
    HWY_INLINE void finish(std::uint16_t* sums, int stride) const
    {
        if constexpr (kVector < kVectors) {
            const auto even = hn::Sub(pairs_[kVector], hn::ShiftLeft<8>(highs_[kVector]));
            put<kStore>(even, sums + kVector * (kN / 2));
            put<kStore>(highs_[kVector], sums + stride / 2 + kVector * (kN / 2));
            finish<kStore, kVector + 1>(sums, stride);
        }
    }

private:
    template <int kVector>
    HWY_INLINE void start(const std::uint8_t* costs)
    {
        if constexpr (kVector < kVectors) {
            pairs_[kVector] = hn::BitCast(D16(), hn::LoadU(D(), costs + kVector * kN));
            highs_[kVector] = hn::ShiftRight<8>(pairs_[kVector]);
            start<kVector + 1>(costs);
        }
    }
    template <bool kStore>
    static HWY_INLINE void put(hn::Vec<D16> value, std::uint16_t* sums)
    {
        const D16 d16;
        hn::StoreU(kStore ? value : hn::Add(hn::LoadU(d16, sums), value), d16, sums);
    }

    hn::Vec<D16> pairs_[kVectors];
    hn::Vec<D16> highs_[kVectors];
};

// Eq. 1. `kVectors` vectors of kLanes hold a pixel's costs; 0: any number.
template <int kLanes, int kVectors>
class WindowStep {
    using D = hn::CappedTag<std::uint8_t, kLanes>;
    using V = hn::Vec<D>;
    static constexpr int kN = int(hn::MaxLanes(D()));
    // Vectors whose sums are in registers at once.
    static constexpr int kAtOnce = 4;

public:
    WindowStep(int stride, int p1)
        : stride_(kVectors > 0 ? kVectors * kN : stride),
          p1_(hn::Set(D(), static_cast<std::uint8_t>(p1)))
    {
    }

    // One pixel of a halo; `now` may be `before`. Returns the least new cost.
    HWY_INLINE std::uint8_t follow(const std::uint8_t* before, std::uint8_t before_least,
                                   std::uint8_t p2, const std::uint8_t* costs,
                                   std::uint8_t* now) const
    {
        Pixel p = pixel(before, before_least, p2, now);
        NoSums<V> none;
        int at = 0;
        for (; at + kAtOnce * kN <= stride(); at += kAtOnce * kN) {
            vectors<kAtOnce>(p, costs, at, none);
        }
        for (; at < stride(); at += kN) {
            vectors<1>(p, costs, at, none);
        }
        return least_lane(D(), p.minimum);
    }

    // kCount paths at every pixel of a row, and the sums of these and the path along the
    // row: stored in the first pass, added in the second.
    template <bool kFirst, int kCount>
    HWY_INLINE void sum_row(const SumRow& row, const std::array<StepPath, 3>& paths) const
    {
        SumRow at = row;
        for (int i = 0; i < row.cols; ++i) {
            sum_pixel<kFirst, kCount>(at, paths, i);
            at.along += row.along_step;
            at.costs += stride();
            at.sums += stride();
        }
    }

private:
    struct Pixel {
        const std::uint8_t* before;
        std::uint8_t* now;
        V least;
        V jump;
        V below;
        V minimum;
    };

    HWY_INLINE int stride() const { return kVectors > 0 ? kVectors * kN : stride_; }

    HWY_INLINE Pixel pixel(const std::uint8_t* before, std::uint8_t before_least,
                           std::uint8_t p2, std::uint8_t* now) const
    {
        const D d;
        const auto least = hn::Set(d, before_least);
        // Saturated: where a path starts in disparities the coarser level never searched,
        // even the least cost may be dear.
        return {before,
                now,
                least,
                hn::SaturatedAdd(least, hn::Set(d, p2)),
                hn::LoadU(d, before - 1),
                hn::Set(d, std::uint8_t{255})};
    }
    HWY_INLINE Pixel pixel(const StepPath& path, int number, std::size_t pitch) const
    {
        std::uint8_t* values = path.values + std::size_t(number) * pitch;
        return pixel(values, path.least[number], path.p2[number], values);
    }

    // Some vectors of all paths, then the next: so a path's least cost so far waits in a
    // register, not the sums of all vectors.
    template <bool kFirst, int kCount>
    HWY_INLINE void sum_pixel(const SumRow& row, const std::array<StepPath, 3>& paths,
                              int number) const
    {
        Pixel a{}; // without a path there are no values to look at
        if constexpr (kCount > 0) {
            a = pixel(paths[0], number, row.pitch);
        }
        Pixel b = kCount > 1 ? pixel(paths[1], number, row.pitch) : a;
        Pixel c = kCount > 2 ? pixel(paths[2], number, row.pitch) : a;
        int at = 0;
        for (; at + kAtOnce * kN <= stride(); at += kAtOnce * kN) {
            sum_vectors<kFirst, kCount, kAtOnce>(row, at, a, b, c);
        }
        for (; at < stride(); at += kN) {
            sum_vectors<kFirst, kCount, 1>(row, at, a, b, c);
        }
        if constexpr (kCount > 0) {
            paths[0].least[number] = least_lane(D(), a.minimum);
        }
        if constexpr (kCount > 1) {
            paths[1].least[number] = least_lane(D(), b.minimum);
        }
        if constexpr (kCount > 2) {
            paths[2].least[number] = least_lane(D(), c.minimum);
        }
    }

    template <bool kFirst, int kCount, int kSome>
    HWY_INLINE void sum_vectors(const SumRow& row, int at, Pixel& a, Pixel& b, Pixel& c) const
    {
        RegisterSums<D, kSome> sums(row.along + at);
        if constexpr (kCount > 0) {
            vectors<kSome>(a, row.costs, at, sums);
        }
        if constexpr (kCount > 1) {
            vectors<kSome>(b, row.costs, at, sums);
        }
        if constexpr (kCount > 2) {
            vectors<kSome>(c, row.costs, at, sums);
        }
        sums.template finish<kFirst>(row.sums + at / 2, stride());
    }

    template <int kSome, int kVector = 0, class Sums>
    HWY_INLINE void vectors(Pixel& p, const std::uint8_t* costs, int at, Sums& sums) const
    {
        if constexpr (kVector < kSome) {
            sums.template add<kVector>(vector(p, costs, at + kVector * kN));
            vectors<kSome, kVector + 1>(p, costs, at, sums);
        }
    }

    HWY_INLINE V vector(Pixel& p, const std::uint8_t* costs, int i) const
    {
        const D d;
        const auto same = hn::LoadU(d, p.before + i);
        const auto above = hn::LoadU(d, p.before + i + 1);
        const auto aside = hn::SaturatedAdd(hn::Min(p.below, above), p1_);
        // Read before `now`, which may lie over it, is written.
        p.below = hn::LoadU(d, p.before + i + kN - 1);
        const auto best = hn::Min(hn::Min(same, p.jump), aside);
        const auto path = hn::SaturatedAdd(hn::LoadU(d, costs + i), hn::Sub(best, p.least));
        hn::StoreU(path, d, p.now + i);
        p.minimum = hn::Min(p.minimum, path);
        return path;
    }

    int stride_;
    V p1_;
};

// Costs of pairs of disparities, of which one is even, from the coarse values v: `count` of
// them, padded with 255 up to `stride`. Returns the least.
template <bool kOddFirst>
HWY_INLINE std::uint8_t spread_pairs(const std::uint8_t* v, int count, int stride,
                                     std::uint8_t* out)
{
    const hn::FixedTag<std::uint8_t, 16> d;
    const auto dear = hn::Set(d, std::uint8_t{255});
    auto least = dear;
    const auto put = [&](int i, auto values) HWY_ATTR {
        if (i + 16 > count) {
            const auto some = hn::FirstN(d, std::size_t(std::max(count - i, 0)));
            values = hn::IfThenElse(some, values, dear);
        }
        least = hn::Min(least, values);
        hn::StoreU(values, d, out + i);
    };
    for (int i = 0; i < stride; i += 32) {
        const auto lower = hn::LoadU(d, v + i / 2);
        const auto upper = hn::LoadU(d, v + i / 2 + 1);
        const auto odd = hn::AverageRound(lower, upper);
        const auto first = kOddFirst ? odd : lower;
        const auto second = kOddFirst ? upper : odd;
        put(i, hn::InterleaveLower(d, first, second));
        if (i + 16 < stride) {
            put(i + 16, hn::InterleaveUpper(d, first, second));
        }
    }
    return least_lane(d, least);
}

// Where a path enters a window: the coarser level's costs `kept`, of the disparities
// `coarse`, for the disparities `fine` (docs/algorithm.md, "Coarse start"), padded with 255
// up to `stride`. Returns the least. `scratch` holds 2 * stride + 256 bytes; 64 bytes may be
// read beyond `kept`.
HWY_INLINE std::uint8_t spread_start(const std::uint8_t* kept, tiling::DisparityRange coarse,
                                     tiling::DisparityRange fine, std::uint8_t unsearched,
                                     int stride, std::uint8_t* scratch, std::uint8_t* out)
{
    const hn::FixedTag<std::uint8_t, 16> d;
    const int count = fine.count();
    const int first = tiling::floor_div(fine.min, 2);
    const int values = count / 2 + 2;
    const std::uint8_t* v = kept + (first - coarse.min);
    if (first < coarse.min || first + values - 1 > coarse.max) {
        // scratch[j]: the cost of coarse disparity first + j. Whole vectors, then what they
        // wrote too much is filled: calls into the C library would take longer.
        const int begin = std::max(first, coarse.min);
        const int end = std::min(first + values, coarse.max + 1);
        const auto fill = hn::Set(d, unsearched);
        for (int j = 0; j < begin - first && j < values; j += 16) {
            hn::StoreU(fill, d, scratch + j);
        }
        for (int j = 0; j < end - begin; j += 16) {
            hn::StoreU(hn::LoadU(d, kept + (begin - coarse.min) + j), d,
                       scratch + (begin - first) + j);
        }
        for (int j = std::max(end - first, 0); j < values; j += 16) {
            hn::StoreU(fill, d, scratch + j);
        }
        v = scratch;
    }
    return fine.min == 2 * first ? spread_pairs<false>(v, count, stride, out)
                                 : spread_pairs<true>(v, count, stride, out);
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
