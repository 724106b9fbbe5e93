#include "matcher/cuda/window_ranges.h"

#include "matcher/cuda/device.cuh"
#include "matcher/median.h"

namespace hsgm::matcher::cuda {

namespace ranges {

constexpr int kThreads = 128;
constexpr int kFootprintMargin = 1;
constexpr int kDropped = 2;
constexpr int kMargin = 4;
constexpr int kFar = 1 << 20; // beyond any disparity
constexpr int kKept = kDropped + 1;

// The three least values seen, in order.
struct Lowest {
    int value[kKept];

    __device__ void clear() { value[0] = value[1] = value[2] = kFar; }
    __device__ void add(int v)
    {
        for (int i = 0; i < kKept; ++i) {
            const int less = least_of(v, value[i]);
            v = most_of(v, value[i]);
            value[i] = less;
        }
    }
};

__device__ int median_winner(const RangeJob& job, int row, int col)
{
    std::array<int, 9> values{};
    std::size_t n = 0;
    for (int dr = -1; dr <= 1; ++dr) {
        const int r = clamped(row + dr, 0, job.coarse_rows - 1);
        for (int dc = -1; dc <= 1; ++dc) {
            values[n++] = job.coarse_winner.at(r, clamped(col + dc, 0, job.coarse_cols - 1));
        }
    }
    return median_of_nine(values);
}

// The coarse pixels under a window and round it.
__device__ Area footprint(const RangeJob& job, const Area& core)
{
    const int row = most_of(core.row / 2 - kFootprintMargin, 0);
    const int col = most_of(core.col / 2 - kFootprintMargin, 0);
    const int row_end =
        least_of((core.row_end() - 1) / 2 + 1 + kFootprintMargin, job.coarse_rows);
    const int col_end =
        least_of((core.col_end() - 1) / 2 + 1 + kFootprintMargin, job.coarse_cols);
    return {row, col, row_end - row, col_end - col};
}

__device__ void set_range(const RangeJob& job, int lowest, int highest, Window& window)
{
    const int least = 2 * lowest - kMargin;
    const int needed = 2 * highest + 1 + kMargin - least + 1;
    const int count = (needed + 15) / 16 * 16;
    if (count >= job.count) {
        return;
    }
    window.least =
        clamped(least - (count - needed) / 2, job.least, job.least + job.count - count);
    window.count = count;
}

__device__ Area core_of(const RangeJob& job, int number)
{
    const int across = ceil_divided(job.area.cols, job.window_px);
    const int row = job.area.row + number / across * job.window_px;
    const int col = job.area.col + number % across * job.window_px;
    return {row, col, least_of(job.window_px, job.area.row_end() - row),
            least_of(job.window_px, job.area.col_end() - col)};
}

// A block for each window.
__global__ void find(const __grid_constant__ RangeJob job)
{
    auto* const lows = reinterpret_cast<Lowest*>(dynamic_shared());
    Lowest* const highs = lows + blockDim.x;
    const int number = static_cast<int>(blockIdx.x);
    const int thread = static_cast<int>(threadIdx.x);
    Window window{core_of(job, number), job.least, job.count};
    if (job.prune) {
        const Area under = footprint(job, window.core);
        const int pixels = under.rows * under.cols;
        Lowest low;
        Lowest high; // of the negated values
        low.clear();
        high.clear();
        for (int p = thread; p < pixels; p += static_cast<int>(blockDim.x)) {
            const int median =
                median_winner(job, under.row + p / under.cols, under.col + p % under.cols);
            low.add(median);
            high.add(-median);
        }
        lows[thread] = low;
        highs[thread] = high;
        for (int half = static_cast<int>(blockDim.x) / 2; half > 0; half /= 2) {
            __syncthreads();
            if (thread < half) {
                for (int i = 0; i < kKept; ++i) {
                    lows[thread].add(lows[thread + half].value[i]);
                    highs[thread].add(highs[thread + half].value[i]);
                }
            }
        }
        const int dropped = pixels >= 2 * kDropped + 1 ? kDropped : 0;
        if (thread == 0) {
            set_range(job, lows[0].value[dropped], -highs[0].value[dropped], window);
        }
    }
    if (thread == 0) {
        job.windows[number] = window;
    }
}

} // namespace ranges

int window_count(const Area& area, int window_px)
{
    return ceil_divided(area.rows, window_px) * ceil_divided(area.cols, window_px);
}

cudaError_t find_window_ranges(const RangeJob& job, cudaStream_t stream)
{
    return launch(ranges::find, window_count(job.area, job.window_px), ranges::kThreads,
                  2 * ranges::kThreads * sizeof(ranges::Lowest), stream, job);
}

} // namespace hsgm::matcher::cuda
