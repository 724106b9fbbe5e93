#pragma once

#include "matcher/cuda/window_frame.cuh"
#include "matcher/pixel.h"
#include "matcher/reasons.h"

namespace hsgm::matcher::cuda {

/// What becomes of the sums of a strip (docs/algorithm.md, section 5).
template <typename Cell, typename Group>
class Winners {
    static constexpr int kWords = Group::kWords;
    static constexpr unsigned kNone = 0xFFFFU; ///< no sum is as dear: 16 paths of 4063

public:
    __device__ Winners(const WindowFrame<Cell>& frame, const Strip& strip)
        : frame_(frame), job_(*frame.job), strip_(strip),
          first_key_col_(frame.window.core.col - frame.window.least - 2 * frame.words() + 1)
    {
    }

    /// Empties the strip's right-view keys.
    __device__ void reset_keys()
    {
        const int count = strip_.rows * job_.strips.key_row;
        for (int i = static_cast<int>(threadIdx.x); i < count;
             i += static_cast<int>(blockDim.x)) {
            frame_.keys[i] = kNoKey;
        }
    }

    /// Finds the winner of every pixel; a group of lanes takes one at a time.
    __device__ void find()
    {
        const Area& core = frame_.window.core;
        const int pixels = strip_.rows * core.cols;
        const int warps = static_cast<int>(blockDim.x) / kWarp;
        const int warp = static_cast<int>(threadIdx.x) / kWarp;
        for (int first = warp * Group::kGroupsPerWarp; first < pixels;
             first += warps * Group::kGroupsPerWarp) {
            const int p = first + Group::group_in_warp();
            const int q = least_of(p, pixels - 1);
            find_at(strip_.row + q / core.cols, core.col + q % core.cols, p < pixels);
        }
    }

    /// Hands the keys of the strip to the tile. After a barrier.
    __device__ void flush_keys()
    {
        const Area& area = job_.tile.keys_area;
        const int cols = frame_.window.core.cols + 2 * frame_.words() - 1;
        for (int i = static_cast<int>(threadIdx.x); i < strip_.rows * cols;
             i += static_cast<int>(blockDim.x)) {
            const int row = strip_.row + i / cols;
            const int col = first_key_col_ + i % cols;
            const unsigned key = frame_.keys[i / cols * job_.strips.key_row + i % cols];
            if (key >> 16 != kNone && area.contains(row, col)) {
                atomicMin(&job_.tile.keys[std::size_t(row - area.row) * std::size_t(area.cols) +
                                          std::size_t(col - area.col)],
                          key);
            }
        }
    }

private:
    __device__ const unsigned* sums_at(int row, int col) const
    {
        return frame_.sums + (row - strip_.row) * job_.strips.sum_row +
               Group::sums_of(col - frame_.window.core.col, frame_.words());
    }

    // Calls f(j, pair) for the words of this lane; what pads the range is dearer than all.
    template <typename F>
    __device__ void each_word(const unsigned* sums, F f) const
    {
        const int words = frame_.words();
        const int count = frame_.window.count;
        for (int round = 0; round < rounds<Group>(words); ++round) {
#pragma unroll
            for (int i = 0; i < kWords; ++i) {
                const int j = round * kWarp + Group::first_word() + i;
                if (Group::kWide && j >= words) {
                    return;
                }
                unsigned pair = sums[Group::kWide ? j : i * kWarp + Group::lane()];
                if (frame_.is_padded()) {
                    pair |= (j < count ? 0U : kNone) | (j + words < count ? 0U : kNone << 16);
                }
                f(j, pair);
            }
        }
    }

    __device__ static int sum_at(const unsigned* sums, int index, int half)
    {
        const int j = index < half ? index : index - half;
        const unsigned pair = sums[Group::place(j)];
        return static_cast<int>(index < half ? pair & 0xFFFFU : pair >> 16);
    }

    // All lanes of the warp come here; those whose pixel is not `wanted` only lend a hand.
    __device__ void find_at(int row, int col, bool wanted)
    {
        const unsigned* const sums = sums_at(row, col);
        const bool gives_keys = wanted && job_.finest && job_.tile.core.contains(row, col) &&
                                is_valid(job_.left_pixels.at(row, col));
        const int half = frame_.words();
        unsigned* const keys = frame_.keys + (row - strip_.row) * job_.strips.key_row +
                               (col - frame_.window.least - first_key_col_);
        const auto offset = static_cast<unsigned>(frame_.window.least - job_.tile.asked_least);
        unsigned least = ~0U;
        each_word(sums, [&](int j, unsigned pair) {
            const unsigned low = pair << 16 | static_cast<unsigned>(j);
            const unsigned high = (pair & 0xFFFF0000U) | static_cast<unsigned>(j + half);
            least = least_of(least, least_of(low, high));
            if (gives_keys) {
                atomicMin(keys - j, low + offset);
                atomicMin(keys - j - half, high + offset);
            }
        });
        least = Group::least_value(least);
        const int index = static_cast<int>(least & 0xFFFFU);
        const int sum = static_cast<int>(least >> 16);
        if (job_.finest) {
            const int rival = rival_of(sums, index);
            if (wanted && Group::lane() == 0 && job_.tile.core.contains(row, col)) {
                write_pixel(sums, row, col, index, sum, rival);
            }
        } else if (wanted) {
            keep_pixel(sums, row, col, index, sum);
        }
    }

    // The least sum at least two disparities from the winner; kNone if there is none.
    __device__ int rival_of(const unsigned* sums, int index) const
    {
        const int half = frame_.words();
        unsigned least = ~0U;
        each_word(sums, [&](int j, unsigned pair) {
            const unsigned near = (near_to(index, j) ? kNone : 0U) |
                                  (near_to(index, j + half) ? kNone << 16 : 0U);
            least = __vminu2(least, pair | near);
        });
        return static_cast<int>(Group::least_value(least_of(least & 0xFFFFU, least >> 16)));
    }
    __device__ static bool near_to(int index, int other)
    {
        return index >= other - 1 && index <= other + 1;
    }

    __device__ void write_pixel(const unsigned* sums, int row, int col, int index, int sum,
                                int rival) const
    {
        const TileArrays& tile = job_.tile;
        const int disparity = frame_.window.least + index;
        const int half = frame_.words();
        const bool inner = index > 0 && index + 1 < frame_.window.count;
        const std::size_t at = std::size_t(row - tile.core.row) * std::size_t(tile.core.cols) +
                               std::size_t(col - tile.core.col);
        tile.disparity_q8[at] = inner ? subpixel_q8(disparity, sum_at(sums, index - 1, half),
                                                    sum, sum_at(sums, index + 1, half))
                                      : disparity * 256;
        tile.confidence[at] = static_cast<std::uint8_t>(
            rival == static_cast<int>(kNone) ? 255 : confidence_of(sum, rival));
        tile.reasons[at] = static_cast<std::uint16_t>(reasons_of(row, col, disparity));
    }

    __device__ unsigned reasons_of(int row, int col, int winner) const
    {
        if (!is_valid(job_.left_pixels.at(row, col))) {
            return kNodataLeft;
        }
        const TileArrays& tile = job_.tile;
        unsigned reasons = 0;
        const int counterpart = col - winner;
        if (col - tile.asked_most > job_.right_cols - 1 || col - tile.asked_least < 0) {
            reasons |= kOutside;
        } else if (counterpart >= 0 && counterpart < job_.right_cols &&
                   !is_valid(job_.right_pixels.at(row, counterpart))) {
            reasons |= kNodataRight;
        }
        if (job_.low_texture.at(row, col) != 0) {
            reasons |= kLowTexture;
        }
        if (tile.asked_most > tile.asked_least &&
            (winner == tile.asked_least || winner == tile.asked_most)) {
            reasons |= kRangeEnd;
        }
        return reasons;
    }

    // Winner and prior, for the finer level.
    __device__ void keep_pixel(const unsigned* sums, int row, int col, int index, int sum) const
    {
        const LevelStore<Cell>& store = job_.store;
        const std::size_t pixel = store.pixel(row, col);
        if (Group::lane() == 0) {
            store.winner[pixel] = static_cast<std::int16_t>(frame_.window.least + index);
        }
        if (store.prior == nullptr) {
            return;
        }
        std::uint8_t* const prior = store.prior + pixel * std::size_t(store.stride);
        const int half = frame_.words();
        const int count = frame_.window.count;
        each_word(sums, [&](int j, unsigned pair) {
            if (j < count) {
                prior[j] = prior_value(static_cast<int>(pair & 0xFFFFU), sum);
            }
            if (half + j < count) {
                prior[half + j] = prior_value(static_cast<int>(pair >> 16), sum);
            }
        });
    }

    // The number of paths as a constant lets the compiler divide by multiplying.
    __device__ std::uint8_t prior_value(int sum, int least) const
    {
        int q = 0;
        switch (job_.directions.count) {
        case 4:
            q = prior_of(sum, least, 4);
            break;
        case 5:
            q = prior_of(sum, least, 5);
            break;
        case 8:
            q = prior_of(sum, least, 8);
            break;
        default:
            q = prior_of(sum, least, 16);
            break;
        }
        return static_cast<std::uint8_t>(q);
    }

    const WindowFrame<Cell>& frame_;
    const SolveJob<Cell>& job_;
    Strip strip_;
    int first_key_col_;
};

} // namespace hsgm::matcher::cuda
