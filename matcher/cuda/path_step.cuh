#pragma once

#include "matcher/cuda/window_frame.cuh"

namespace hsgm::matcher::cuda {

/// Path costs of one pixel, shared out to a group of lanes: L_r(p, d), and their minimum in
/// both halves of `least`.
template <int kGroup, int kWords>
struct PathState {
    using Group = LaneGroup<kGroup, kWords>;

    unsigned cost[kWords];
    unsigned least;

    /// Where no path comes from: with these, eq. 1 gives L = C.
    __device__ void begin()
    {
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            cost[i] = 0;
        }
        least = 0;
    }

    /// Makes everything beyond `count` disparities infinitely dear.
    __device__ void pad(int count)
    {
        const int low = count - Group::first_word();
        const int high = low - kGroup * kWords;
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            const unsigned dear =
                (i < low ? 0U : kInfinite) | (i < high ? 0U : kInfinite << 16);
            const unsigned keep = (i < low ? 0xFFFFU : 0U) | (i < high ? 0xFFFF0000U : 0U);
            cost[i] = (cost[i] & keep) | dear;
        }
    }

    __device__ void find_least()
    {
        unsigned word = cost[0];
#pragma unroll
        for (int i = 1; i < kWords; ++i) {
            word = lesser(word, cost[i]);
        }
        least = Group::least_half(word);
    }

    /// Eq. 1 for the next pixel of the path, whose matching costs are at `matching`, a word
    /// every kGroup. P1 and P2' in both halves. All lanes of the warp call it.
    __device__ void step(const unsigned* matching, unsigned p1, unsigned p2)
    {
        // The words beside this lane's. At the ends of the range a half is missing, and the
        // other is the first or last of the other lot of halves.
        unsigned before = cost[kWords - 1];
        unsigned after = cost[0];
        if constexpr (kGroup > 1) {
            const int lane = Group::lane();
            before = __shfl_sync(kAllLanes, before, lane + kGroup - 1, kGroup);
            after = __shfl_sync(kAllLanes, after, lane + 1, kGroup);
        }
        if (Group::lane() == 0) {
            before = before << 16 | kInfinite;
        }
        if (Group::lane() == kGroup - 1) {
            after = after >> 16 | kInfinite << 16;
        }
        const unsigned jump = least + p2;
        unsigned minimum = kInfinitePair;
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            const unsigned next = i + 1 < kWords ? cost[i + 1] : after;
            const unsigned aside = lesser(before, next) + p1;
            const unsigned best = lesser(cost[i], jump, aside);
            before = cost[i];
            // No half borrows from the other: best >= least in both.
            cost[i] = matching[i * kGroup] + best - least;
        }
#pragma unroll
        for (int i = 0; i + 1 < kWords; i += 2) {
            minimum = lesser(minimum, cost[i], cost[i + 1]);
        }
        if constexpr (kWords % 2 == 1) {
            minimum = lesser(minimum, cost[kWords - 1]);
        }
        least = Group::least_half(minimum);
    }

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
