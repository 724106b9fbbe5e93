#pragma once

#include "matcher/cuda/block_costs.cuh"
#include "matcher/cuda/line_follower.cuh"
#include "matcher/cuda/strip_costs.cuh"
#include "matcher/cuda/winners.cuh"

#include <type_traits>

namespace hsgm::matcher::cuda {

constexpr int kMostThreads = 384;

/// A block solves one window, strip by strip.
///
/// The sums of a pixel need paths from above and from below, but those of a whole window do
/// not fit on the chip. So paths that go up run twice. First alone, from bottom to top, leaving
/// their state at the top of every strip in device memory; then strips are solved from top to
/// bottom, with the paths of all directions: up from the state that the strip below left, down
/// from where the strip above ended, along by themselves.
/// Costs over blocks have kernels of their own: beside the others they would find too few
/// registers.
template <typename Cell, typename Group, bool kBlocks>
class WindowSolver {
    using Follower = LineFollower<Cell, Group>;
    using Costs = std::conditional_t<kBlocks, BlockCosts<Cell, Group>, StripCosts<Cell, Group>>;

public:
    __device__ explicit WindowSolver(const WindowFrame<Cell>& frame)
        : frame_(frame), job_(*frame.job), core_(frame.window.core),
          height_(frame.job->strips.rows), core_strips_(ceil_divided(core_.rows, height_))
    {
    }

    __device__ void solve()
    {
        const int climbs = goes_up() ? core_strips_ + strips_below() - 1 : 0;
        const int above = ceil_divided(core_.row - top(), height_);
        const int steps = climbs + above + core_strips_;
        for (int step = 0; step < steps; ++step) {
            const int down = step - climbs;
            const bool in_core = down >= above;
            const Way way = down < 0 ? Way::up : (in_core ? Way::all : Way::down);
            const int number = down < 0 ? climbs - step : most_of(down - above, 0);
            solve_strip(way == Way::down ? strip_above(down) : strip_of(number), way, number);
        }
    }

private:
    /// Which paths run through a strip; all of them where sums are wanted.
    enum class Way { up, down, all };

    __device__ bool goes_up() const
    {
        bool any = false;
        for (int d = 0; d < job_.directions.count; ++d) {
            any = any || job_.directions.row[d] < 0;
        }
        return any;
    }

    // Where paths that go down begin.
    __device__ int top() const { return most_of(core_.row - job_.halo_px, 0); }
    // Where paths that go up begin.
    __device__ int bottom() const
    {
        return least_of(core_.row_end() + job_.halo_px, job_.image.rows);
    }
    __device__ int strips_below() const
    {
        return ceil_divided(bottom() - core_.row_end(), height_);
    }

    // Strips count from the top of the core, through the halo below it.
    __device__ Strip strip_of(int number) const
    {
        const bool in_core = number < core_strips_;
        const int begin = in_core ? core_.row : core_.row_end();
        const int row = begin + (in_core ? number : number - core_strips_) * height_;
        return {row, least_of(height_, (in_core ? core_.row_end() : bottom()) - row)};
    }
    __device__ Strip strip_above(int number) const
    {
        const int row = top() + number * height_;
        return {row, least_of(height_, core_.row - row)};
    }

    __device__ void solve_strip(const Strip& strip, Way way, int number)
    {
        const bool sums = way == Way::all;
        prepare(strip, sums);
        follow_lines(strip, way, number, sums);
        __syncthreads();
        if (sums) {
            Winners<Cell, Group> winners(frame_, strip);
            winners.find();
            __syncthreads();
            if (job_.finest) {
                winners.flush_keys();
                __syncthreads();
            }
        }
    }

    // Everything that a strip's paths need, up to and with the barrier before them.
    __device__ void prepare(const Strip& strip, bool adds_up)
    {
        Costs costs(frame_, strip);
        costs.fill();
        if (threadIdx.x == 0) {
            *frame_.task = 0;
        }
        if (adds_up) {
            const int count = strip.rows * job_.strips.sum_row;
            for (int i = static_cast<int>(threadIdx.x); i < count;
                 i += static_cast<int>(blockDim.x)) {
                frame_.sums[i] = 0;
            }
            if (job_.finest) {
                Winners<Cell, Group>(frame_, strip).reset_keys();
            }
        }
        __syncthreads();
    }

    __device__ bool goes(int d, Way way) const
    {
        const int dr = job_.directions.row[d];
        return way == Way::all || (way == Way::up ? dr < 0 : dr > 0);
    }

    // Warps take pieces of work as they come free. The order of directions starts with those
    // along the rows, whose lines are the longest.
    __device__ void follow_lines(const Strip& strip, Way way, int number, bool add_up)
    {
        const int most_lines = most_of(job_.strips.line_slots, strip.rows);
        const int pieces = ceil_divided(most_lines, Group::kGroupsPerWarp);
        const int of_direction = job_.directions.count == kMostDirections ? 2 * pieces : pieces;
        for (;;) {
            const int task = next_task();
            const int direction = task / of_direction;
            if (direction >= job_.directions.count) {
                return;
            }
            const int piece = task % of_direction;
            const int dr = job_.directions.row[direction];
            const int lines = dr == 0 ? strip.rows : path_region(job_, core_, direction).cols;
            const typename Follower::Task work{direction, piece / pieces,
                                               piece % pieces * Group::kGroupsPerWarp};
            const bool has_phase = work.phase < (dr < 0 ? -dr : most_of(dr, 1));
            if (goes(direction, way) && has_phase && work.line < lines) {
                follow(strip, work, number, add_up);
            }
        }
    }

    __device__ int next_task()
    {
        int task = 0;
        if (threadIdx.x % kWarp == 0) {
            task = atomicAdd(frame_.task, 1);
        }
        return __shfl_sync(kAllLanes, task, 0);
    }

    __device__ void follow(const Strip& strip, const typename Follower::Task& work, int number,
                           bool add_up)
    {
        const int dr = job_.directions.row[work.direction];
        const std::size_t of_direction = std::size_t(job_.directions.count == 16 ? 2 : 1) *
                                         std::size_t(job_.strips.line_slots) *
                                         std::size_t(2 * frame_.words());
        const std::size_t at = std::size_t(rank(work.direction)) * of_direction;
        // Paths that go up are kept at every strip while they climb, and start from there when
        // sums are wanted; until then the room of those that go down is theirs, too.
        Cell* const checkpoint =
            frame_.checkpoints + std::size_t(number * ranks()) * of_direction + at;
        const bool resumes = dr < 0 && add_up;
        const Cell* const from =
            resumes ? checkpoint + std::size_t(ranks()) * of_direction : frame_.parked + at;
        Cell* const to = dr == 0 || resumes ? nullptr : frame_.parked + at;
        const bool keeps = dr < 0 && !add_up && number <= core_strips_;
        Cell* const copy = keeps ? checkpoint : nullptr;
        Follower(frame_, strip, work).follow(from, to, copy, add_up);
    }

    // Number of a direction among those that go its way, up or down.
    __device__ int rank(int direction) const
    {
        int n = 0;
        for (int d = 0; d < direction; ++d) {
            n += (job_.directions.row[d] > 0) == (job_.directions.row[direction] > 0) &&
                         job_.directions.row[d] != 0
                     ? 1
                     : 0;
        }
        return n;
    }
    // Directions that go up.
    __device__ int ranks() const
    {
        int n = 0;
        for (int d = 0; d < job_.directions.count; ++d) {
            n += job_.directions.row[d] < 0 ? 1 : 0;
        }
        return n;
    }

    const WindowFrame<Cell>& frame_;
    const SolveJob<Cell>& job_;
    Area core_;
    int height_;
    int core_strips_;
};

/// Points a frame at the block's memory: what is needed most is shared, if it fits.
template <typename Cell, typename Group>
__device__ WindowFrame<Cell> frame_of(const SolveJob<Cell>& job)
{
    unsigned char* const shared = dynamic_shared();
    unsigned char* const scratch =
        job.scratch + std::size_t(blockIdx.x) * job.strips.scratch_bytes;
    unsigned char* const strips = Group::kWide ? scratch : shared;
    const StripLayout& at = job.strips;
    WindowFrame<Cell> frame{};
    frame.job = &job;
    frame.task = reinterpret_cast<int*>(shared + at.control);
    frame.penalties = reinterpret_cast<unsigned*>(shared + at.penalties);
    frame.keys = reinterpret_cast<unsigned*>(strips + at.keys);
    frame.costs = reinterpret_cast<unsigned*>(strips + at.costs);
    frame.sums = reinterpret_cast<unsigned*>(strips + at.sums);
    frame.parked =
        reinterpret_cast<Cell*>((at.parked_in_shared ? shared : scratch) + at.parked);
    frame.checkpoints = reinterpret_cast<Cell*>(scratch + at.checkpoints);
    if constexpr (Group::kWide) {
        frame.wide = reinterpret_cast<unsigned*>(scratch + at.wide) +
                     threadIdx.x / kWarp * 2 * static_cast<unsigned>(at.words);
    }
    if constexpr (kGuardBytes > 0) {
        for (const std::size_t end : at.shared_ends) {
            forbid_shared(shared + end - kGuardBytes, kGuardBytes);
        }
    }
    return frame;
}

/// Solves the windows of a job: each block takes one after the other.
template <typename Cell, typename Group, bool kBlocks = false>
__global__ void __launch_bounds__(kMostThreads, 1)
    solve_windows(const __grid_constant__ SolveJob<Cell> job)
{
    WindowFrame<Cell> frame = frame_of<Cell, Group>(job);
    for (int a = static_cast<int>(threadIdx.x); a < 256; a += static_cast<int>(blockDim.x)) {
        frame.penalties[a] = pair_of(job.p2[a]);
    }
    for (;;) {
        __syncthreads();
        if (threadIdx.x == 0) {
            *frame.task = atomicAdd(job.next_window, 1);
        }
        __syncthreads();
        const int number = *frame.task;
        if (number >= job.window_count) {
            return;
        }
        __syncthreads();
        const Window window = job.windows[number];
        if (window.count <= job.over_count || window.count > job.up_to_count) {
            continue;
        }
        frame.window = window;
        frame.first_col = most_of(window.core.col - job.halo_px, 0);
        frame.end_col = least_of(window.core.col_end() + job.halo_px, job.image.cols);
        WindowSolver<Cell, Group, kBlocks>(frame).solve();
    }
}

} // namespace hsgm::matcher::cuda
