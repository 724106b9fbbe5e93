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
    HWY_INLINE void add_at(int, V) {}
};

// Sums of a pixel with up to four vectors of costs, in registers: of 16-bit lanes that hold
// two costs each, the sum of both and the sum of the high ones.
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

// Sums of a pixel with any number of vectors, in memory.
template <class D>
class MemorySums {
    static constexpr int kN = int(hn::MaxLanes(D()));

public:
    HWY_INLINE MemorySums(const std::uint8_t* first, bool store, std::uint16_t* sums,
                          int stride)
        : sums_(sums), stride_(stride)
    {
        for (int i = 0; i < stride; i += kN) {
            add_to_sums(D(), hn::LoadU(D(), first + i), i, stride, sums, store);
        }
    }
    HWY_INLINE void add_at(int i, hn::Vec<D> costs)
    {
        add_to_sums(D(), costs, i, stride_, sums_, false);
    }

private:
    std::uint16_t* sums_;
    int stride_;
};

// Eq. 1. `kVectors` vectors of kLanes hold a pixel's costs; 0: any number.
template <int kLanes, int kVectors>
class WindowStep {
    using D = hn::CappedTag<std::uint8_t, kLanes>;
    using V = hn::Vec<D>;
    static constexpr int kN = int(hn::MaxLanes(D()));

public:
    WindowStep(int stride, int p1)
        : stride_(stride), p1_(hn::Set(D(), static_cast<std::uint8_t>(p1)))
    {
    }

    // One pixel of a halo; `now` may be `before`. Returns the least new cost.
    HWY_INLINE std::uint8_t follow(const std::uint8_t* before, std::uint8_t before_least,
                                   std::uint8_t p2, const std::uint8_t* costs,
                                   std::uint8_t* now) const
    {
        NoSums<V> none;
        return step(before, before_least, p2, costs, now, none);
    }

    // kCount paths at every pixel of a row, and the sums of these and the path along the
    // row: stored in the first pass, added in the second.
    template <bool kFirst, int kCount>
    HWY_INLINE void sum_row(const SumRow& row, const std::array<StepPath, 3>& paths) const
    {
        const std::array<StepPath, 3> path = paths;
        const std::uint8_t* along = row.along;
        const std::uint8_t* costs = row.costs;
        std::uint16_t* sums = row.sums;
        for (int i = 0; i < row.cols; ++i) {
            if constexpr (kVectors > 0) {
                RegisterSums<D, kVectors> pixel(along);
                follow_all<kCount>(path, i, row.pitch, costs, pixel);
                pixel.template finish<kFirst>(sums, stride_);
            } else {
                MemorySums<D> pixel(along, kFirst, sums, stride_);
                follow_all<kCount>(path, i, row.pitch, costs, pixel);
            }
            along += row.along_step;
            costs += stride_;
            sums += stride_;
        }
    }

private:
    struct Pixel {
        const std::uint8_t* before;
        const std::uint8_t* costs;
        std::uint8_t* now;
        V least;
        V jump;
        V below;
        V minimum;
    };

    template <int kCount, class Sums>
    HWY_INLINE void follow_all(const std::array<StepPath, 3>& paths, int pixel,
                               std::size_t pitch, const std::uint8_t* costs, Sums& sums) const
    {
        if constexpr (kCount > 0) {
            follow_one(paths[0], pixel, pitch, costs, sums);
        }
        if constexpr (kCount == 3) {
            follow_one(paths[1], pixel, pitch, costs, sums);
            follow_one(paths[2], pixel, pitch, costs, sums);
        }
    }
    template <class Sums>
    HWY_INLINE void follow_one(const StepPath& path, int pixel, std::size_t pitch,
                               const std::uint8_t* costs, Sums& sums) const
    {
        std::uint8_t* values = path.values + std::size_t(pixel) * pitch;
        path.least[pixel] =
            step(values, path.least[pixel], path.p2[pixel], costs, values, sums);
    }

    template <class Sums>
    HWY_INLINE std::uint8_t step(const std::uint8_t* before, std::uint8_t before_least,
                                 std::uint8_t p2, const std::uint8_t* costs, std::uint8_t* now,
                                 Sums& sums) const
    {
        const D d;
        Pixel p;
        p.before = before;
        p.costs = costs;
        p.now = now;
        p.least = hn::Set(d, before_least);
        // Saturated: where a path starts in disparities the coarser level never searched,
        // even the least cost may be dear.
        p.jump = hn::SaturatedAdd(p.least, hn::Set(d, p2));
        p.below = hn::LoadU(d, before - 1);
        p.minimum = hn::Set(d, std::uint8_t{255});
        if constexpr (kVectors > 0) {
            vectors<0>(p, sums);
        } else {
            for (int i = 0; i < stride_; i += kN) {
                sums.add_at(i, vector(p, i));
            }
        }
        return least_lane(d, p.minimum);
    }

    template <int kVector, class Sums>
    HWY_INLINE void vectors(Pixel& p, Sums& sums) const
    {
        if constexpr (kVector < kVectors) {
            sums.template add<kVector>(vector(p, kVector * kN));
            vectors<kVector + 1>(p, sums);
        }
    }

    HWY_INLINE V vector(Pixel& p, int i) const
    {
        const D d;
        const auto same = hn::LoadU(d, p.before + i);
        const auto above = hn::LoadU(d, p.before + i + 1);
        const auto aside = hn::SaturatedAdd(hn::Min(p.below, above), p1_);
        // Read before `now`, which may lie over it, is written.
        p.below = hn::LoadU(d, p.before + i + kN - 1);
        const auto best = hn::Min(hn::Min(same, p.jump), aside);
        const auto path = hn::SaturatedAdd(hn::LoadU(d, p.costs + i), hn::Sub(best, p.least));
        hn::StoreU(path, d, p.now + i);
        p.minimum = hn::Min(p.minimum, path);
        return path;
    }

    int stride_;
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
    std::uint8_t* spread = scratch + stride / 2 + 96;
    for (int j = 0; j < values; j += 16) {
        const auto even = hn::LoadU(d, scratch + j);
        const auto odd = hn::AverageRound(even, hn::LoadU(d, scratch + j + 1));
        hn::StoreU(hn::InterleaveLower(d, even, odd), d, spread + 2 * j);
        hn::StoreU(hn::InterleaveUpper(d, even, odd), d, spread + 2 * j + 16);
    }
    spread += fine.min - 2 * first;
    for (int i = count; i < stride; i += 16) {
        hn::StoreU(hn::Set(d, std::uint8_t{255}), d, spread + i);
    }
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
