#pragma once

#include "matcher/cuda/packed.cuh"
#include "matcher/cuda/solve_job.h"

namespace hsgm::matcher::cuda {

/// Rows of a window's costs, or of its halo's, that are in reach at a time.
struct Strip {
    int row;
    int rows;

    HSGM_HOST_DEVICE int row_end() const { return row + rows; }
};

/// What all threads of a block know of the window that they solve.
template <typename Cell>
struct WindowFrame {
    const SolveJob<Cell>* job;
    Window window;
    int first_col; ///< of the costs: core and halo on both sides
    int end_col;
    // Memory of the block.
    int* task; ///< next piece of work of the strip
    unsigned* penalties;
    unsigned* keys;
    unsigned* costs;
    unsigned* sums;
    Cell* parked;
    Cell* checkpoints;
    unsigned* wide; ///< of the warp, for WideGroup

    __device__ int words() const { return job->strips.words; }
    __device__ bool is_padded() const { return window.count < 2 * words(); }
};

/// The pixels that paths of direction `d` run over: the core, and the halo on the sides that
/// they come from.
template <typename Cell>
__device__ Area path_region(const SolveJob<Cell>& job, const Area& core, int d)
{
    const int h = job.halo_px;
    const int dr = job.directions.row[d];
    const int dc = job.directions.col[d];
    const int row = most_of(core.row - (dr > 0 ? h : 0), 0);
    const int col = most_of(core.col - (dc > 0 ? h : 0), 0);
    const int row_end = least_of(core.row_end() + (dr < 0 ? h : 0), job.image.rows);
    const int col_end = least_of(core.col_end() + (dc < 0 ? h : 0), job.image.cols);
    return {row, col, row_end - row, col_end - col};
}

/// Lanes that share a pixel's disparities. The words of a pixel hold the disparities j and
/// j + half of the range; lane g has the words g * kWords ... g * kWords + kWords - 1, so that
/// a disparity's neighbours lie in the words before and after it, in the same half:
///
///     lane            0                   1          ...
///     low halves      0 1 2 3 4 5 6 7     8 9 ...           half - 1
///     high halves     half ...                          2 * half - 1
///
/// Matching costs take a byte: a lane's lie side by side, and it reads them at once. Sums are
/// words. Those of the pixels that a warp has room for are interleaved, so that groups of lanes
/// that work side by side write to different banks: word i of all of them, then word i + 1.
template <int kLaneCount, int kWordCount>
struct LaneGroup {
    static constexpr int kLanes = kLaneCount;
    static constexpr int kWords = kWordCount;
    static constexpr bool kWide = false;
    static constexpr int kGroupsPerWarp = kWarp / kLanes;
    static constexpr int kCostWords = kWords / 2; ///< of matching costs, four in each

    __device__ static int lane() { return static_cast<int>(threadIdx.x) % kLanes; }
    __device__ static int group_in_warp()
    {
        return static_cast<int>(threadIdx.x) % kWarp / kLanes;
    }
    __device__ static int first_word() { return lane() * kWords; }
    /// Where the sums of a row's pixel begin.
    __device__ static int sums_of(int pixel, int)
    {
        const unsigned lane = static_cast<unsigned>(pixel) * kLanes;
        return static_cast<int>(lane / kWarp * kWarp * kWords + lane % kWarp);
    }
    /// Where word `j` of a pixel's sums lies, from there.
    __device__ static int place(int j) { return j % kWords * kWarp + j / kWords; }

    /// The least half of all words of all lanes of the group, in both halves.
    __device__ static unsigned least_half(unsigned word)
    {
        word = lesser(word, swapped(word));
#pragma unroll
        for (int by = 1; by < kLanes; by *= 2) {
            word = lesser(word, __shfl_xor_sync(kAllLanes, word, by));
        }
        return word;
    }
    /// The least value of all lanes of the group.
    __device__ static unsigned least_value(unsigned value)
    {
#pragma unroll
        for (int by = 1; by < kLanes; by *= 2) {
            value = least_of(value, __shfl_xor_sync(kAllLanes, value, by));
        }
        return value;
    }
};

/// A warp that shares any number of words, one a lane at a time: word j belongs to lane j % 32
/// and lies at j.
struct WideGroup : LaneGroup<kWarp, 1> {
    static constexpr bool kWide = true;
    __device__ static int sums_of(int pixel, int words) { return pixel * words; }
};

/// Words of a pixel that a lane sees one after the other in rounds; one round but for
/// WideGroup.
template <typename Group>
__device__ int rounds(int words)
{
    return Group::kWide ? (words + kWarp - 1) / kWarp : 1;
}

} // namespace hsgm::matcher::cuda
