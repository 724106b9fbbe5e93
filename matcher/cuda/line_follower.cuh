#pragma once

#include "matcher/cuda/coarse_values.cuh"
#include "matcher/cuda/path_step.cuh"

namespace hsgm::matcher::cuda {

/// A group of lanes follows one line of a direction through a strip.
///
/// Lines that leave the region on one side go on on the other, where a path enters: so every
/// row has a pixel of each line, and a line is the same in all strips:
///
///     direction (1, 1):   0 1 2 3      row 0
///                         3 0 1 2      row 1: line 3 left on the right, enters on the left
///                         2 3 0 1      row 2
///
/// Directions with steps of two rows have two lots of lines, `phase` 0 and 1.
template <typename Cell, int kGroup, int kWords>
class LineFollower {
    using Group = LaneGroup<kGroup, kWords>;
    static constexpr int kCells = 2 * kWords; // of a lane

public:
    /// One piece of work: kGroupsPerWarp lines from `line` on.
    struct Task {
        int direction;
        int phase;
        int line;
    };

    __device__ LineFollower(const WindowFrame<Cell>& frame, const Strip& strip,
                            const Task& task)
        : frame_(frame), job_(*frame.job), strip_(strip), direction_(task.direction),
          dr_(job_.directions.row[task.direction]), dc_(job_.directions.col[task.direction]),
          region_(path_region(job_, frame.window.core, task.direction)), phase_(task.phase)
    {
        const int lines = dr_ == 0 ? strip.rows : region_.cols;
        const int line = task.line + Group::group_in_warp();
        active_ = line < lines;
        line_ = least_of(line, lines - 1);
    }

    /// `from` and `to` are where the lines of this direction wait between strips; null where
    /// they do not. With `add_up`, costs are added to the sums.
    __device__ void follow(const Cell* from, Cell* to, bool add_up)
    {
        int steps = place_first();
        bool first = true;
        for (; steps > 0; --steps, advance(), first = false) {
            if (first && from != nullptr && !enters()) {
                state_.resume(from + slot());
                if (frame_.is_padded()) {
                    state_.pad(frame_.window.count);
                }
            }
            enter(enters());
            const int tone = job_.tone.at(row_, col_);
            const int before = enters() ? start_tone(tone) : tone_before(first);
            last_tone_ = tone;
            state_.step(matching(), pair_of(static_cast<unsigned>(job_.p1)),
                        frame_.penalties[tone < before ? before - tone : tone - before]);
            if (active_ && frame_.window.core.contains(row_, col_)) {
                if (add_up) {
                    add_to_sums();
                }
                if (!job_.finest && add_up) {
                    keep_line();
                }
            }
        }
        if (to != nullptr && active_ && !first) {
            state_.park(to + slot());
        }
    }

private:
    // Sets row_ and col_ to the line's first pixel of the strip; how many there are.
    __device__ int place_first()
    {
        if (dr_ == 0) {
            row_ = strip_.row + line_;
            col_ = dc_ > 0 ? region_.col : region_.col_end() - 1;
            return region_.cols;
        }
        const int step = dr_ > 0 ? dr_ : -dr_;
        // Rows from where the direction begins, in the strip and in the region.
        const int begin =
            dr_ > 0 ? strip_.row - region_.row : region_.row_end() - strip_.row_end();
        const int end = begin + strip_.rows;
        const int first = begin + (phase_ + step - begin % step) % step;
        if (first >= end) {
            return 0;
        }
        row_ = dr_ > 0 ? region_.row + first : region_.row_end() - 1 - first;
        const int cols = region_.cols;
        const int along = (line_ + dc_ * (first / step)) % cols;
        col_ = region_.col + (along < 0 ? along + cols : along);
        return (end - 1 - first) / step + 1;
    }

    __device__ void advance()
    {
        row_ += dr_;
        col_ += dc_;
        if (dr_ != 0) {
            while (col_ >= region_.col_end()) {
                col_ -= region_.cols;
            }
            while (col_ < region_.col) {
                col_ += region_.cols;
            }
        }
    }

    __device__ bool enters() const { return !region_.contains(row_ - dr_, col_ - dc_); }

    __device__ std::size_t slot() const
    {
        const int line = phase_ * job_.strips.line_slots + line_;
        return (std::size_t(line) * kGroup + std::size_t(Group::lane())) * kCells;
    }

    // Where paths enter the region: afresh, or with the coarser level's costs (eq. 2). All
    // lanes of the warp come here, for the exchange at the end.
    __device__ void enter(bool entering)
    {
        if (__any_sync(kAllLanes, entering) == 0) {
            return;
        }
        const bool coarse =
            entering && job_.has_coarser && job_.image.contains(row_ - dr_, col_ - dc_);
        if (entering) {
            state_.begin();
        }
        if (coarse) {
            read_coarse();
        }
        if (__any_sync(kAllLanes, coarse) != 0) {
            const unsigned known = state_.least;
            state_.find_least();
            state_.least = coarse ? state_.least : known;
        }
    }

    __device__ void read_coarse()
    {
        const int row = (row_ - dr_) / 2;
        const int col = (col_ - dc_) / 2;
        const Window& coarse = job_.coarser.window_at(row, col);
        const CoarseValues<Cell> values{job_.coarser.line_at(direction_, row, col),
                                        coarse.least, coarse.count, job_.unsearched};
        const int least = frame_.window.least + Group::first_word();
        const int half = kGroup * kWords;
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            const auto low = static_cast<unsigned>(values.at(least + i));
            const auto high = static_cast<unsigned>(values.at(least + half + i));
            state_.cost[i] = low | high << 16;
        }
        if (frame_.is_padded()) {
            state_.pad(frame_.window.count);
        }
    }

    __device__ int start_tone(int tone) const
    {
        const int row = row_ - dr_;
        const int col = col_ - dc_;
        if (!job_.image.contains(row, col)) {
            return tone;
        }
        return job_.equation_3 && job_.has_coarser ? job_.coarser_tone.at(row / 2, col / 2)
                                                   : job_.tone.at(row, col);
    }
    __device__ int tone_before(bool first) const
    {
        return first ? job_.tone.at(row_ - dr_, col_ - dc_) : last_tone_;
    }

    __device__ const unsigned* matching() const
    {
        return frame_.costs + (row_ - strip_.row) * job_.strips.cost_row +
               (col_ - frame_.first_col) * job_.strips.pixel_stride + Group::lane();
    }

    __device__ void add_to_sums() const
    {
        unsigned* const sums = frame_.sums + (row_ - strip_.row) * job_.strips.sum_row +
                               (col_ - frame_.window.core.col) * job_.strips.pixel_stride +
                               Group::lane();
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            atomicAdd(&sums[i * kGroup], state_.cost[i]);
        }
    }

    __device__ void keep_line() const
    {
        if (!job_.store.grid.holds(row_, dr_) && !job_.store.grid.holds(col_, dc_)) {
            return;
        }
        Cell* const kept = job_.store.line_at(direction_, row_, col_);
        const int first = Group::first_word();
        const int half = kGroup * kWords;
#pragma unroll
        for (int i = 0; i < kWords; ++i) {
            const unsigned pair = state_.cost[i] - state_.least;
            if (first + i < frame_.window.count) {
                kept[first + i] = static_cast<Cell>(pair & 0xFFFFU);
            }
            if (half + first + i < frame_.window.count) {
                kept[half + first + i] = static_cast<Cell>(pair >> 16);
            }
        }
    }

    const WindowFrame<Cell>& frame_;
    const SolveJob<Cell>& job_;
    Strip strip_;
    int direction_;
    int dr_;
    int dc_;
    Area region_;
    int phase_;
    bool active_ = false;
    int line_ = 0;
    int row_ = 0;
    int col_ = 0;
    int last_tone_ = 0;
    PathState<kGroup, kWords> state_;
};

} // namespace hsgm::matcher::cuda
