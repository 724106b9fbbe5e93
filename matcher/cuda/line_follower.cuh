#pragma once

#include "matcher/cuda/coarse_values.cuh"
#include "matcher/cuda/wide_state.cuh"

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
template <typename Cell, typename Group>
class LineFollower {
public:
    /// One piece of work: Group::kGroupsPerWarp lines from `line` on.
    struct Task {
        int direction;
        int phase;
        int line;
    };

    __device__ LineFollower(const WindowFrame<Cell>& frame, const Strip& strip,
                            const Task& task)
        : frame_(frame), job_(*frame.job), strip_(strip), direction_(task.direction),
          dr_(job_.directions.row[task.direction]), dc_(job_.directions.col[task.direction]),
          region_(path_region(job_, frame.window.core, task.direction)), phase_(task.phase),
          state_(frame.wide, frame.words(), frame.window.count)
    {
        const int lines = dr_ == 0 ? strip.rows : region_.cols;
        const int line = task.line + Group::group_in_warp();
        active_ = line < lines;
        line_ = least_of(line, lines - 1);
    }

    /// `from` and `to` are where the lines of this direction wait between strips, `copy` where
    /// else their state is kept; null where they do not. With `add_up`, costs are added to the
    /// sums.
    __device__ void follow(const Cell* from, Cell* to, Cell* copy, bool add_up)
    {
        const int steps = place_first();
        int last_tone = 0;
        bool enters = !region_.contains(row_ - dr_, col_ - dc_);
        for (int step = 0; step < steps; ++step) {
            const int tone = job_.tone.at(row_, col_);
            if (step == 0 && !enters) {
                last_tone = job_.tone.at(row_ - dr_, col_ - dc_);
                resume(from);
            }
            if (__any_sync(kAllLanes, enters) != 0) {
                enter(enters);
            }
            const int before = enters ? start_tone(tone) : last_tone;
            last_tone = tone;
            state_.step(matching(), pair_of(static_cast<unsigned>(job_.p1)),
                        frame_.penalties[tone < before ? before - tone : tone - before],
                        job_.one);
            if (add_up && active_ && is_in_core()) {
                add_to_sums();
                keep_line();
            }
            enters = advance();
        }
        if (active_ && steps > 0) {
            if (to != nullptr) {
                state_.park(to + slot());
            }
            if (copy != nullptr) {
                state_.park(copy + slot());
            }
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
        const int first = begin + (step == 2 ? (phase_ + begin) & 1 : 0);
        if (first >= end) {
            return 0;
        }
        row_ = dr_ > 0 ? region_.row + first : region_.row_end() - 1 - first;
        const int cols = region_.cols;
        const int along = (line_ + dc_ * (first / step)) % cols;
        col_ = region_.col + (along < 0 ? along + cols : along);
        return (end - 1 - first) / step + 1;
    }

    // To the next pixel; whether a path enters there.
    __device__ bool advance()
    {
        row_ += dr_;
        col_ += dc_;
        if (dr_ == 0 || is_between(col_, region_.col, region_.cols)) {
            return false;
        }
        while (col_ >= region_.col_end()) {
            col_ -= region_.cols;
        }
        while (col_ < region_.col) {
            col_ += region_.cols;
        }
        return true;
    }

    // Strips that add up lie in rows of the core.
    __device__ bool is_in_core() const
    {
        return is_between(col_, frame_.window.core.col, frame_.window.core.cols);
    }
    __device__ static bool is_between(int at, int begin, int count)
    {
        return static_cast<unsigned>(at - begin) < static_cast<unsigned>(count);
    }

    __device__ int slot() const
    {
        const int line = phase_ * job_.strips.line_slots + line_;
        return Group::kWide ? line * 2 * frame_.words()
                            : (line * Group::kLanes + Group::lane()) * 2 * Group::kWords;
    }

    // Lanes that only lend a hand stay away from the line that they stand in for: another
    // group of the warp parks it, and votes and shuffles put no memory in order.
    __device__ void resume(const Cell* from)
    {
        if (!active_) {
            state_.begin();
            return;
        }
        state_.resume(from + slot());
        if (frame_.is_padded()) {
            state_.pad();
        }
    }

    // Where paths enter the region: afresh, or with the coarser level's costs (eq. 2). All
    // lanes of the warp come here, for the exchange at the end.
    __device__ void enter(bool enters)
    {
        const bool coarse =
            enters && job_.has_coarser && job_.image.contains(row_ - dr_, col_ - dc_);
        if (enters) {
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
        const int least = frame_.window.least;
        const int half = frame_.words();
        state_.each_word([&](int j, unsigned& word) {
            word = static_cast<unsigned>(values.at(least + j)) |
                   static_cast<unsigned>(values.at(least + half + j)) << 16;
        });
        if (frame_.is_padded()) {
            state_.pad();
        }
    }

    __device__ int start_tone(int tone) const
    {
        const int row = row_ - dr_;
        const int col = col_ - dc_;
        if (!job_.image.contains(row, col)) {
            return tone;
        }
        return job_.equation_3 ? job_.coarser_tone.at(row / 2, col / 2)
                               : job_.tone.at(row, col);
    }

    __device__ const unsigned* matching() const
    {
        return frame_.costs + (row_ - strip_.row) * job_.strips.cost_row +
               (col_ - frame_.first_col) * job_.strips.cost_pixel +
               (Group::kWide ? 0 : Group::lane() * Group::kCostWords);
    }

    __device__ void add_to_sums()
    {
        unsigned* const sums = frame_.sums + (row_ - strip_.row) * job_.strips.sum_row +
                               Group::sums_of(col_ - frame_.window.core.col, frame_.words()) +
                               (Group::kWide ? 0 : Group::lane());
        state_.each_sum([sums](int at, unsigned word) { atomicAdd(&sums[at], word); });
    }

    __device__ void keep_line()
    {
        if (job_.finest ||
            (!job_.store.grid.holds(row_, dr_) && !job_.store.grid.holds(col_, dc_))) {
            return;
        }
        Cell* const kept = job_.store.line_at(direction_, row_, col_);
        const int count = frame_.window.count;
        const int half = frame_.words();
        const unsigned least = state_.least;
        state_.each_word([=](int j, unsigned& word) {
            const unsigned pair = word - least;
            if (j < count) {
                kept[j] = static_cast<Cell>(pair & 0xFFFFU);
            }
            if (half + j < count) {
                kept[half + j] = static_cast<Cell>(pair >> 16);
            }
        });
    }

    const WindowFrame<Cell>& frame_;
    const SolveJob<Cell>& job_;
    Strip strip_;
    int direction_;
    int dr_;
    int dc_;
    Area region_;
    int phase_;
    StateOf<Group> state_;
    bool active_ = false;
    int line_ = 0;
    int row_ = 0;
    int col_ = 0;
};

} // namespace hsgm::matcher::cuda
