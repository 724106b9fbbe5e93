#pragma once

#include "matcher/cuda/path_step.cuh"

#include <type_traits>

namespace hsgm::matcher::cuda {

/// A PathState for ranges that no registers hold: a warp shares the pixel, and its words lie in
/// device memory. Two sets of them, so that neighbours are read before they are written over.
struct WideState {
    using Group = WideGroup;

    unsigned* cost;
    unsigned* next;
    int words;
    int count;
    unsigned least = 0;

    /// `memory` has room for 2 * n words.
    __device__ WideState(unsigned* memory, int n, int disparities)
        : cost(memory), next(memory + n), words(n), count(disparities)
    {
    }

    template <typename F>
    __device__ void each_word(F f)
    {
        for (int j = Group::lane(); j < words; j += kWarp) {
            f(j, cost[j]);
        }
    }

    template <typename F>
    __device__ void each_sum(F f)
    {
        each_word([&f](int j, unsigned& word) { f(j, word); });
    }

    __device__ void begin()
    {
        each_word([](int, unsigned& word) { word = 0; });
        least = 0;
    }
    __device__ void pad()
    {
        const int half = words;
        const int most = count;
        each_word(
            [half, most](int j, unsigned& word) { word = padded_word(word, j, half, most); });
    }
    __device__ void find_least()
    {
        unsigned minimum = kInfinitePair;
        each_word([&minimum](int, unsigned& word) { minimum = lesser(minimum, word); });
        least = Group::least_half(minimum);
    }

    __device__ void step(const unsigned* matching, unsigned p1, unsigned p2, unsigned)
    {
        __syncwarp(); // lanes read what their neighbours wrote
        const unsigned jump = least + p2;
        const auto* const costs = reinterpret_cast<const std::uint16_t*>(matching);
        unsigned minimum = kInfinitePair;
        for (int j = Group::lane(); j < words; j += kWarp) {
            const unsigned before = j > 0 ? cost[j - 1] : cost[words - 1] << 16 | kInfinite;
            const unsigned after =
                j + 1 < words ? cost[j + 1] : cost[0] >> 16 | kInfinite << 16;
            const unsigned aside = lesser(before, after) + p1;
            const unsigned path =
                padded_word(__dp2a_lo(kCostFactors, static_cast<unsigned>(costs[j]),
                                      lesser(cost[j], jump, aside) - least),
                            j, words, count);
            next[j] = path;
            minimum = lesser(minimum, path);
        }
        least = Group::least_half(minimum);
        unsigned* const old = cost;
        cost = next;
        next = old;
        __syncwarp(); // nobody writes over what a neighbour still reads
    }

    /// Word j lies at 2 * j, as two values.
    template <typename Cell>
    __device__ void park(Cell* to)
    {
        const unsigned now = least;
        each_word([to, now](int j, unsigned& word) {
            const unsigned value = word - now;
            to[2 * j] = static_cast<Cell>(value & 0xFFFFU);
            to[2 * j + 1] = static_cast<Cell>(value >> 16);
        });
    }
    template <typename Cell>
    __device__ void resume(const Cell* from)
    {
        each_word([from](int j, unsigned& word) {
            word = from[2 * j] | static_cast<unsigned>(from[2 * j + 1]) << 16;
        });
        least = 0;
    }
};

/// What follows a line with this kind of group.
template <typename Group>
using StateOf = std::conditional_t<Group::kWide, WideState, PathState<Group>>;

} // namespace hsgm::matcher::cuda
