#pragma once

#include "matcher/cuda/window_frame.cuh"
#include "matcher/pixel.h"
#include "matcher/reasons.h"

namespace hsgm::matcher::cuda {

/// What becomes of the sums of a strip (docs/algorithm.md, section 5).
template <typename Cell, int kGroup, int kWords>
class Winners {
    using Group = LaneGroup<kGroup, kWords>;
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
               (col - frame_.window.core.col) * job_.strips.pixel_stride;
    }

    // Word i of this lane, with what pads the range dearer than all.
    __device__ unsigned sums_word(const unsigned* sums, int i) const
    {
        unsigned pair = sums[i * kGroup + Group::lane()];
        if (frame_.is_padded()) {
            const int j = Group::first_word() + i;
            pair |= (j < frame_.window.count ? 0U : kNone) |
                    (j + frame_.words() < frame_.window.count ? 0U : kNone << 16);
        }
        return pair;
    }

    __device__ static int sum_at(const unsigned* sums, int index, int half)
    {
        const int j = index < half ? index : index - half;
        const unsigned pair = sums[j % kWords * kGroup + j / kWords];
        return static_cast<int>(index < half ? pair & 0xFFFFU : pair >> 16);
    }

    // All lanes of the warp come here; those whose pixel is not `wanted` only lend a hand.
    __device__ void find_at(int row, int col, bool wanted)
    {
        const unsigned* const sums = sums_at(row, col);
        const bool gives_keys = wanted && job_.finest && job_.tile.core.contains(row, col) &&
                                is_valid(job_.left_pixels.at(row, col));
        const int half = frame_.words();
        const int first = Group::first_word();
        unsigned* const keys = frame_.keys + (row - strip_.row) * job_.strips.key_row +
                               (col - frame_.window.least - first - first_key_col_);
        const auto offset = static_cast<unsigned>(frame_.window.least - job_.tile.asked_least);
        unsigned least = ~0U;
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            const unsigned pair = sums_word(sums, i);
            const auto j = static_cast<unsigned>(first + i);
            const unsigned low = pair << 16 | j;
            const unsigned high = (pair & 0xFFFF0000U) | (j + static_cast<unsigned>(half));
            least = least_of(least, least_of(low, high));
            if (gives_keys) {
                atomicMin(keys - i, low + offset);
                atomicMin(keys - i - half, high + offset);
            }
        }
#pragma unroll
        for (int by = 1; by < kGroup; by *= 2) {
            least = least_of(least, __shfl_xor_sync(kAllLanes, least, by));
        }
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
        const int low = index - Group::first_word();
        const int high = low - frame_.words();
        unsigned least = ~0U;
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            const unsigned near =
                (near_to(low, i) ? kNone : 0U) | (near_to(high, i) ? kNone << 16 : 0U);
            least = __vminu2(least, sums_word(sums, i) | near);
        }
        unsigned rival = least_of(least & 0xFFFFU, least >> 16);
#pragma unroll
        for (int by = 1; by < kGroup; by *= 2) {
            rival = least_of(rival, __shfl_xor_sync(kAllLanes, rival, by));
        }
        return static_cast<int>(rival);
    }
    __device__ static bool near_to(int index, int i)
    {
        return index >= i - 1 && index <= i + 1;
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
        const int first = Group::first_word();
        const int half = frame_.words();
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            const unsigned pair = sums[i * kGroup + Group::lane()];
            if (first + i < frame_.window.count) {
                prior[first + i] = prior_value(static_cast<int>(pair & 0xFFFFU), sum);
            }
            if (first + half + i < frame_.window.count) {
                prior[first + half + i] = prior_value(static_cast<int>(pair >> 16), sum);
            }
        }
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
