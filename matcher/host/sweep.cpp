#include "matcher/host/sweep.h"

#include "matcher/matcher.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/sweep.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After Highway: compiled once for every target.
#include "matcher/host/sweep_step-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

// Rows that a direction along the row follows side by side.
constexpr int kRowsAlong = 4;

template <typename L>
void keep_line(const SweepJob<L>& job, int row, int col, const L* path, L least)
{
    L* kept = job.lines->at(row, col);
    for (int i = 0; i < job.cost.stride; ++i) {
        kept[i] = static_cast<L>(path[i] - least);
    }
}

// Rows of path costs in flight: as many as the step of the direction, and one more; or those
// that are followed side by side.
template <typename L>
class PathRows {
public:
    PathRows(const SweepJob<L>& job, SweepWorkspace<L>& workspace)
        : region_(job.region), pitch_(std::size_t(job.cost.stride) + kGuard),
          count_(job.direction.row == 0 ? kRowsAlong : std::abs(job.direction.row) + 1)
    {
        const std::size_t row = pitch_ * std::size_t(region_.cols) + kGuard;
        values_ = workspace.rows.need(row * std::size_t(count_));
        least_ = workspace.least.need(std::size_t(region_.cols) * std::size_t(count_));
        row_ = row;
        for (int r = 0; r < count_; ++r) {
            for (int c = 0; c <= region_.cols; ++c) {
                std::fill_n(values_ + std::size_t(r) * row_ + std::size_t(c) * pitch_, kGuard,
                            kInfinite<L>);
            }
        }
    }
    L* at(int row, int col)
    {
        return values_ + slot(row) * row_ + std::size_t(col - region_.col) * pitch_ + kGuard;
    }
    L& least(int row, int col)
    {
        return least_[slot(row) * std::size_t(region_.cols) + std::size_t(col - region_.col)];
    }

private:
    std::size_t slot(int row) const { return std::size_t((row - region_.row) % count_); }

    tiling::Rect region_;
    std::size_t pitch_;
    int count_;
    std::size_t row_ = 0;
    L* values_ = nullptr;
    L* least_ = nullptr;
};

// Everything that eq. 1 reads and writes for one pixel, and how far the next one lies.
template <typename L>
struct Cursor {
    const L* before;
    const L* before_least;
    L* now;
    L* least;
    const std::uint8_t* costs;
    std::uint16_t* sums; // null outside the core
    const std::uint8_t* tone;
    const std::uint8_t* before_tone;

    HWY_INLINE void advance(std::ptrdiff_t pixels, std::ptrdiff_t pitch, std::ptrdiff_t stride)
    {
        before += pixels * pitch;
        now += pixels * pitch;
        before_least += pixels;
        least += pixels;
        costs += pixels * stride;
        sums += sums != nullptr ? pixels * stride : 0;
        tone += pixels;
        before_tone += pixels;
    }
};

template <int kLanes, typename L>
class Sweep {
public:
    Sweep(const SweepJob<L>& job, SweepWorkspace<L>& workspace)
        : job_(job), rows_(job, workspace),
          start_(workspace.start.need(2 * std::size_t(job.cost.stride) + 6 * kGuard))
    {
    }

    // The pixels [col_begin, col_end) of one row of a direction that comes from another row:
    // they do not depend on each other.
    void row(int row, int col_begin, int col_end)
    {
        const tiling::Rect& region = job_.region;
        const int dc = job_.direction.col;
        int first = col_end;
        int last = col_end;
        if (row - job_.direction.row >= region.row &&
            row - job_.direction.row < region.row_end()) {
            first = std::clamp(region.col + std::max(dc, 0), col_begin, col_end);
            last = std::clamp(region.col_end() + std::min(dc, 0), first, col_end);
        }
        entries(row, col_begin, first);
        const bool core_row = row >= job_.core.row && row < job_.core.row_end();
        const int core_first = core_row ? std::clamp(job_.core.col, first, last) : last;
        const int core_last =
            core_row ? std::clamp(job_.core.col_end(), core_first, last) : last;
        run<1>(row, first, core_first, 1);
        run<1>(row, core_first, core_last, 1);
        run<1>(row, core_last, last, 1);
        entries(row, last, col_end);
        keep_lines(row, col_begin, col_end);
    }

    // kRows whole rows of a direction along the row. Each pixel waits for the one before it,
    // so rows are followed side by side to keep the processor busy meanwhile.
    template <int kRows>
    void rows_along(int row)
    {
        const tiling::Rect& region = job_.region;
        const int dc = job_.direction.col;
        const int step = dc > 0 ? 1 : -1;
        const int begin = dc > 0 ? region.col : region.col_end() - 1;
        for (int k = 0; k < kRows; ++k) {
            pixel(row + k, begin);
        }
        // The halo lies before the core only: [begin + step, turn) is halo, the rest core.
        const int turn = dc > 0 ? std::max(job_.core.col, begin + 1)
                                : std::min(job_.core.col_end() - 1, begin - 1);
        const int end = dc > 0 ? region.col_end() : region.col - 1;
        run<kRows>(row, begin + step, turn, step);
        run<kRows>(row, turn, end, step);
        for (int k = 0; k < kRows; ++k) {
            keep_lines(row + k, region.col, region.col_end());
        }
    }

private:
    // Pixels whose predecessors all lie in the region, from `col` up to (not including)
    // `end`; all in the core or none.
    template <int kRows>
    void run(int row, int col, int end, int step)
    {
        const int count = (end - col) * step;
        if (count <= 0) {
            return;
        }
        std::array<Cursor<L>, kRows> cursors;
        for (int k = 0; k < kRows; ++k) {
            cursors[std::size_t(k)] = cursor(row + k, col);
        }
        const auto pitch =
            static_cast<std::ptrdiff_t>(job_.cost.stride) + static_cast<std::ptrdiff_t>(kGuard);
        for (int i = 0; i < count; ++i) {
            for (Cursor<L>& c : cursors) {
                const int p2 = penalty(*c.tone, *c.before_tone);
                *c.least = Step<kLanes, L>::follow(c.before, *c.before_least, c.costs,
                                                   job_.cost.stride, job_.penalties.p1, p2,
                                                   c.now, c.sums, job_.first);
                c.advance(step, pitch, job_.cost.stride);
            }
        }
    }

    Cursor<L> cursor(int row, int col)
    {
        const int from_row = row - job_.direction.row;
        const int from_col = col - job_.direction.col;
        return {rows_.at(from_row, from_col), &rows_.least(from_row, from_col),
                rows_.at(row, col),           &rows_.least(row, col),
                job_.cost.at(row, col),       sums_at(row, col),
                &job_.tone->at(row, col),     &job_.tone->at(from_row, from_col)};
    }

    // Pixels where paths enter the region.
    void entries(int row, int col_begin, int col_end)
    {
        for (int col = col_begin; col < col_end; ++col) {
            pixel(row, col);
        }
    }

    void pixel(int row, int col)
    {
        const int from_row = row - job_.direction.row;
        const int from_col = col - job_.direction.col;
        const std::uint8_t* costs = job_.cost.at(row, col);
        std::uint16_t* sums = sums_at(row, col);
        L* now = rows_.at(row, col);
        L& least = rows_.least(row, col);
        if (job_.start != nullptr && job_.image.contains(from_row, from_col)) {
            L before_least = 0;
            const L* before = coarse_costs(from_row, from_col, before_least);
            const int p2 = penalty(job_.tone->at(row, col), start_tone(from_row, from_col));
            least = Step<kLanes, L>::follow(before, before_least, costs, job_.cost.stride,
                                            job_.penalties.p1, p2, now, sums, job_.first);
        } else {
            least = Step<kLanes, L>::begin(costs, job_.cost.stride, now, sums, job_.first);
        }
    }

    void keep_lines(int row, int col_begin, int col_end)
    {
        if (job_.lines == nullptr || row < job_.core.row || row >= job_.core.row_end()) {
            return;
        }
        const bool line_row = job_.lines->holds_row(row);
        const int begin = std::max(col_begin, job_.core.col);
        const int end = std::min(col_end, job_.core.col_end());
        for (int col = begin; col < end; ++col) {
            if (line_row || job_.lines->holds_col(col)) {
                keep_line(job_, row, col, rows_.at(row, col), rows_.least(row, col));
            }
        }
    }

    std::uint16_t* sums_at(int row, int col) const
    {
        if (!job_.core.contains(row, col)) {
            return nullptr;
        }
        return job_.sums + (std::size_t(row - job_.core.row) * std::size_t(job_.core.cols) +
                            std::size_t(col - job_.core.col)) *
                               std::size_t(job_.cost.stride);
    }
    int penalty(int tone, int other) const
    {
        return job_.penalties.p2[std::size_t(std::abs(tone - other))];
    }
    int start_tone(int row, int col) const
    {
        return job_.coarse_tone != nullptr ? job_.coarse_tone->at(row / 2, col / 2)
                                           : job_.tone->at(row, col);
    }
    const L* coarse_costs(int row, int col, L& least)
    {
        L* out = start_ + kGuard;
        L* scratch = out + job_.cost.stride + 2 * kGuard;
        const int count = job_.cost.range.count();
        job_.start->costs(row, col, job_.direction_number, job_.cost.range, scratch, out);
        std::fill_n(out - kGuard, kGuard, kInfinite<L>);
        std::fill(out + count, out + job_.cost.stride + kGuard, kInfinite<L>);
        least = *std::min_element(out, out + count);
        return out;
    }

    const SweepJob<L>& job_;
    PathRows<L> rows_;
    L* start_;
};

// Rows of a direction that stays in its row do not depend on each other.
template <int kLanes, typename L>
void sweep_along(const SweepJob<L>& job, SweepWorkspace<L>& workspace, int begin, int end)
{
    Sweep<kLanes, L> one(job, workspace);
    int row = begin;
    for (; row + kRowsAlong <= end; row += kRowsAlong) {
        one.template rows_along<kRowsAlong>(row);
    }
    for (; row < end; ++row) {
        one.template rows_along<1>(row);
    }
}

template <int kLanes, typename L>
void sweep_rows_apart(const SweepJob<L>& job, SweepWorkspace<L>& workspace)
{
    if (!job.spread_over_threads) {
        sweep_along<kLanes>(job, workspace, job.region.row, job.region.row_end());
        return;
    }
    tbb::parallel_for(tbb::blocked_range<int>(job.region.row, job.region.row_end(), 16),
                      [&](const tbb::blocked_range<int>& rows) {
                          SweepWorkspace<L> own;
                          sweep_along<kLanes>(job, own, rows.begin(), rows.end());
                      });
}

// Rows one after the other; the pixels of a row only look at earlier rows, so a long row
// may be shared out. (A level that is shared out is solved whole: no path starts from a
// coarser one, so the parts do not meet in the start buffer.)
template <int kLanes, typename L>
void sweep_rows_in_turn(const SweepJob<L>& job, SweepWorkspace<L>& workspace)
{
    Sweep<kLanes, L> one(job, workspace);
    const int rows = job.region.rows;
    const int part_cols = 32768 / job.cost.stride + 1;
    for (int i = 0; i < rows; ++i) {
        const int row =
            job.direction.row > 0 ? job.region.row + i : job.region.row_end() - 1 - i;
        if (!job.spread_over_threads) {
            one.row(row, job.region.col, job.region.col_end());
            continue;
        }
        tbb::parallel_for(
            tbb::blocked_range<int>(job.region.col, job.region.col_end(), part_cols),
            [&](const tbb::blocked_range<int>& cols) {
                one.row(row, cols.begin(), cols.end());
            });
    }
}

template <int kLanes, typename L>
void sweep_lanes(const SweepJob<L>& job, SweepWorkspace<L>& workspace)
{
    if (job.direction.row == 0) {
        sweep_rows_apart<kLanes>(job, workspace);
    } else {
        sweep_rows_in_turn<kLanes>(job, workspace);
    }
}

template <typename L>
void sweep_any(const SweepJob<L>& job, SweepWorkspace<L>& workspace)
{
    if (job.cost.stride % 64 == 0) {
        sweep_lanes<64 / sizeof(L)>(job, workspace);
    } else if (job.cost.stride % 32 == 0) {
        sweep_lanes<32 / sizeof(L)>(job, workspace);
    } else {
        sweep_lanes<16 / sizeof(L)>(job, workspace);
    }
}

void sweep8(const SweepJob<std::uint8_t>& job, SweepWorkspace<std::uint8_t>& workspace)
{
    sweep_any(job, workspace);
}

void sweep16(const SweepJob<std::uint16_t>& job, SweepWorkspace<std::uint16_t>& workspace)
{
    sweep_any(job, workspace);
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(sweep8);
HWY_EXPORT(sweep16);

void sweep(const SweepJob<std::uint8_t>& job, SweepWorkspace<std::uint8_t>& workspace)
{
    HWY_DYNAMIC_DISPATCH(sweep8)(job, workspace);
}

void sweep(const SweepJob<std::uint16_t>& job, SweepWorkspace<std::uint16_t>& workspace)
{
    HWY_DYNAMIC_DISPATCH(sweep16)(job, workspace);
}

} // namespace hsgm::matcher::host

namespace hsgm::matcher {

const char* vector_instructions()
{
    // Of those compiled and supported here, the best has the lowest bit.
    const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
    return hwy::TargetName(usable & -usable);
}

} // namespace hsgm::matcher
#endif
