#pragma once

#include "matcher/cuda/window_frame.cuh"

namespace hsgm::matcher::cuda {

/// Matching costs are stored as bytes, those of the high half twice: with 1 for the low half
/// and 0x8000 for the high one, a product of 16-bit and 8-bit numbers adds two of them to a
/// word, and the units that do it are not those of the minima.
constexpr unsigned kCostFactors = 0x80000001U;

/// Two words of costs, all under 128, as they are stored.
__device__ __forceinline__ unsigned stored_costs(unsigned bytes)
{
    return bytes + (bytes & 0xFF00FF00U);
}

/// Word j of a pixel, with disparities beyond `count` infinitely dear.
__device__ __forceinline__ unsigned padded_word(unsigned word, int j, int half, int count)
{
    if (j >= count) {
        return kInfinitePair;
    }
    return j + half >= count ? (word & 0xFFFFU) | kInfinite << 16 : word;
}

/// Path costs of one pixel, shared out to a group of lanes: L_r(p, d), and their minimum in
/// both halves of `least`.
template <typename LaneGroup>
struct PathState {
    using Group = LaneGroup;
    static constexpr int kWords = Group::kWords;
    static constexpr int kLanes = Group::kLanes;

    unsigned cost[kWords];
    unsigned beyond[kWords]; ///< infinite where the range ends before
    unsigned least;
    // At the ends of the range a half is missing, and the other is the first or last of the
    // other lot of halves: which bytes to take of a word and of kInfinitePair.
    unsigned before_bytes = Group::lane() == 0 ? 0x1054 : 0x3210;
    unsigned after_bytes = Group::lane() == kLanes - 1 ? 0x7632 : 0x3210;

    __device__ PathState(unsigned*, int, int count)
    {
        const int low = count - Group::first_word();
        const int high = low - kLanes * kWords;
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            beyond[i] = (i < low ? 0U : kInfinite) | (i < high ? 0U : kInfinite << 16);
        }
    }

    /// Calls f(j, word) for every word j of this lane.
    template <typename F>
    __device__ void each_word(F f)
    {
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            f(Group::first_word() + i, cost[i]);
        }
    }

    /// Calls f(at, word) with the places of this lane's words among the sums of a pixel, from
    /// the lane's first on.
    template <typename F>
    __device__ void each_sum(F f) const
    {
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            f(i * kWarp, cost[i]);
        }
    }

    /// Where no path comes from: with these, eq. 1 gives L = C.
    __device__ void begin()
    {
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            cost[i] = 0;
        }
        least = 0;
    }

    /// Makes everything beyond the range infinitely dear.
    __device__ void pad()
    {
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            cost[i] = most(cost[i], beyond[i]);
        }
    }

    __device__ void find_least()
    {
        static_assert(kWords % 2 == 0);
        unsigned word = lesser(cost[0], cost[1]);
#pragma unroll
        for (int i = 2; i < kWords; i += 2) {
            word = lesser(word, cost[i], cost[i + 1]);
        }
        least = Group::least_half(word);
    }

    /// Eq. 1 for the next pixel of the path, whose matching costs are at `matching`. P1 and
    /// P2' in both halves. All lanes of the warp call it. `one` is 1, but
    /// the compiler does not know: a product and sum go through other units than the minima.
    __device__ void step(const unsigned* matching, unsigned p1, unsigned p2, unsigned one)
    {
        // The words beside this lane's.
        unsigned before = cost[kWords - 1];
        unsigned after = cost[0];
        if constexpr (kLanes > 1) {
            const int lane = Group::lane();
            before = __shfl_sync(kAllLanes, before, lane + kLanes - 1, kLanes);
            after = __shfl_sync(kAllLanes, after, lane + 1, kLanes);
        }
        before = __byte_perm(before, kInfinitePair, before_bytes);
        after = __byte_perm(after, kInfinitePair, after_bytes);
        const unsigned jump = least + p2;
        const Costs costs(matching);
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            const unsigned next = i + 1 < kWords ? cost[i + 1] : after;
            const unsigned aside = lesser(before, next) * one + p1;
            const unsigned best = lesser(cost[i], jump, aside);
            before = cost[i];
            // No half borrows from the other: best >= least in both.
            cost[i] = costs.added(best + beyond[i] - least, i);
        }
        find_least();
    }

    /// The matching costs of this lane, read at once.
    struct Costs {
        unsigned word[Group::kCostWords];

        __device__ explicit Costs(const unsigned* from)
        {
            if constexpr (Group::kCostWords == 4) {
                const uint4 all = *reinterpret_cast<const uint4*>(from);
                word[0] = all.x;
                word[1] = all.y;
                word[2] = all.z;
                word[3] = all.w;
            } else {
                for (int i = 0; i < Group::kCostWords; ++i) {
                    word[i] = from[i];
                }
            }
        }
        /// `sum` and the costs of word `i`.
        __device__ unsigned added(unsigned sum, int i) const
        {
            return i % 2 == 0 ? __dp2a_lo(kCostFactors, word[i / 2], sum)
                              : __dp2a_hi(kCostFactors, word[i / 2], sum);
        }
    };

    /// L - min L of every disparity, for later.
    __device__ void park(std::uint8_t* to) const
    {
        auto* const words = reinterpret_cast<unsigned*>(to);
#pragma unroll
        for (int i = 0; i < kWords; i += 2) {
            words[i / 2] = to_bytes(cost[i] - least, cost[i + 1] - least);
        }
    }
    __device__ void park(std::uint16_t* to) const
    {
        auto* const words = reinterpret_cast<unsigned*>(to);
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            words[i] = cost[i] - least;
        }
    }
    /// The same back again. Eq. 1 does not change where its L are all less by the same.
    __device__ void resume(const std::uint8_t* from)
    {
        const auto* const words = reinterpret_cast<const unsigned*>(from);
#pragma unroll
        for (int i = 0; i < kWords; i += 2) {
            const unsigned bytes = words[i / 2];
            cost[i] = first_of_bytes(bytes);
            cost[i + 1] = second_of_bytes(bytes);
        }
        least = 0;
    }
    __device__ void resume(const std::uint16_t* from)
    {
        const auto* const words = reinterpret_cast<const unsigned*>(from);
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            cost[i] = words[i];
        }
        least = 0;
    }
};

} // namespace hsgm::matcher::cuda
