#include "matcher/host/sweep.h"

#include "matcher/matcher.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/sweep.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Path costs of neighbouring pixels are stored one guard apart, so that d-1 of the first and
// d+1 of the last disparity read the guard: infinitely dear.
constexpr std::size_t kGuard = 16;

template <typename L>
constexpr L kInfinite = std::numeric_limits<L>::max();

// Adds the L of one vector to the 16-bit sums.
template <class D, class V>
HWY_INLINE void add_to_sums(D, V path, std::uint16_t* HWY_RESTRICT sums, bool first)
{
    using L = hn::TFromD<D>;
    if constexpr (sizeof(L) == 1) {
        const hn::Rebind<std::uint16_t, hn::Half<D>> d16;
        const auto low = hn::PromoteTo(d16, hn::LowerHalf(hn::Half<D>(), path));
        const auto high = hn::PromoteTo(d16, hn::UpperHalf(hn::Half<D>(), path));
        const std::size_t half = hn::Lanes(d16);
        if (first) {
            hn::StoreU(low, d16, sums);
            hn::StoreU(high, d16, sums + half);
        } else {
            hn::StoreU(hn::Add(hn::LoadU(d16, sums), low), d16, sums);
            hn::StoreU(hn::Add(hn::LoadU(d16, sums + half), high), d16, sums + half);
        }
    } else {
        const D d;
        hn::StoreU(first ? path : hn::SaturatedAdd(hn::LoadU(d, sums), path), d, sums);
    }
}

// Folds a vector to 128 bits, pairs of bytes to 16-bit lanes, and asks for their minimum,
// which is one instruction there.
template <class D>
HWY_INLINE hn::TFromD<D> least_lane(D d, hn::Vec<D> v)
{
    using L = hn::TFromD<D>;
    if constexpr (sizeof(L) * hn::MaxLanes(d) > 16) {
        const hn::Half<D> half;
        return least_lane(half, hn::Min(hn::UpperHalf(half, v), hn::LowerHalf(half, v)));
    } else {
        const hn::RepartitionToWide<hn::CappedTag<std::uint8_t, 16>> d16;
        if constexpr (sizeof(L) == 1) {
            const auto pairs = hn::BitCast(d16, v);
            const auto low = hn::And(pairs, hn::Set(d16, 0xFF));
            return static_cast<L>(
                hn::GetLane(hn::MinOfLanes(d16, hn::Min(low, hn::ShiftRight<8>(pairs)))));
        } else {
            return hn::GetLane(hn::MinOfLanes(d16, v));
        }
    }
}

template <class D>
HWY_INLINE auto load_costs(D d, const std::uint8_t* costs)
{
    using L = hn::TFromD<D>;
    if constexpr (sizeof(L) == 1) {
        return hn::LoadU(d, costs);
    } else {
        // The padding 255 has to become infinite in 16 bits too.
        const hn::Rebind<std::uint8_t, D> d8;
        const auto wide = hn::PromoteTo(d, hn::LoadU(d8, costs));
        return hn::IfThenElse(hn::Eq(wide, hn::Set(d, L{255})), hn::Set(d, kInfinite<L>), wide);
    }
}

template <int kLanes, typename L>
struct Step {
    using D = hn::CappedTag<L, kLanes>;

    // Eq. 1 for one pixel. `before` are the predecessor's path costs, with readable guards
    // on both sides; returns the least new cost.
    static HWY_INLINE L follow(const L* HWY_RESTRICT before, L before_least,
                               const std::uint8_t* HWY_RESTRICT costs, int stride, int p1,
                               int p2, L* HWY_RESTRICT now, std::uint16_t* HWY_RESTRICT sums,
                               bool first)
    {
        const D d;
        const auto penalty1 = hn::Set(d, static_cast<L>(p1));
        const auto least = hn::Set(d, before_least);
        const auto jump =
            hn::Set(d, static_cast<L>(std::min<int>(before_least + p2, kInfinite<L>)));
        auto minimum = hn::Set(d, kInfinite<L>);
        for (int i = 0; i < stride; i += static_cast<int>(hn::Lanes(d))) {
            const auto same = hn::LoadU(d, before + i);
            const auto aside =
                hn::Min(hn::LoadU(d, before + i - 1), hn::LoadU(d, before + i + 1));
            const auto best = hn::Min(hn::Min(same, jump), hn::SaturatedAdd(aside, penalty1));
            const auto path =
                hn::SaturatedAdd(load_costs(d, costs + i), hn::SaturatedSub(best, least));
            hn::StoreU(path, d, now + i);
            minimum = hn::Min(minimum, path);
            if (sums != nullptr) {
                add_to_sums(d, path, sums + i, first);
            }
        }
        return least_lane(d, minimum);
    }

    // L = C, where a path begins.
    static HWY_INLINE L begin(const std::uint8_t* HWY_RESTRICT costs, int stride,
                              L* HWY_RESTRICT now, std::uint16_t* HWY_RESTRICT sums, bool first)
    {
        const D d;
        auto minimum = hn::Set(d, kInfinite<L>);
        for (int i = 0; i < stride; i += static_cast<int>(hn::Lanes(d))) {
            const auto path = load_costs(d, costs + i);
            hn::StoreU(path, d, now + i);
            minimum = hn::Min(minimum, path);
            if (sums != nullptr) {
                add_to_sums(d, path, sums + i, first);
            }
        }
        return least_lane(d, minimum);
    }

private:
};

template <typename L>
void keep_line(const SweepJob<L>& job, int row, int col, const L* path, L least)
{
    L* kept = job.lines->at(row, col);
    for (int i = 0; i < job.cost.stride; ++i) {
        kept[i] = static_cast<L>(path[i] - least);
    }
}

// Rows of path costs in flight: as many as the longest step of the direction, and one more.
template <typename L>
class PathRows {
public:
    PathRows(const SweepJob<L>& job, SweepWorkspace<L>& workspace)
        : region_(job.region), pitch_(std::size_t(job.cost.stride) + kGuard),
          count_(std::abs(job.direction.row) + 1)
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

template <int kLanes, typename L>
class Sweep {
public:
    Sweep(const SweepJob<L>& job, SweepWorkspace<L>& workspace)
        : job_(job), rows_(job, workspace),
          start_(workspace.start.need(2 * std::size_t(job.cost.stride) + 6 * kGuard))
    {
    }

    // The pixels [col_begin, col_end) of one row, in path order.
    void row(int row, int col_begin, int col_end)
    {
        const int step = job_.direction.col < 0 ? -1 : 1;
        const bool line_row = job_.lines != nullptr && job_.lines->holds_row(row);
        for (int i = 0; i < col_end - col_begin; ++i) {
            const int col = step > 0 ? col_begin + i : col_end - 1 - i;
            pixel(row, col);
            if (job_.lines != nullptr && job_.core.contains(row, col) &&
                (line_row || job_.lines->holds_col(col))) {
                keep_line(job_, row, col, rows_.at(row, col), rows_.least(row, col));
            }
        }
    }

private:
    void pixel(int row, int col)
    {
        const int from_row = row - job_.direction.row;
        const int from_col = col - job_.direction.col;
        const std::uint8_t* costs = job_.cost.at(row, col);
        std::uint16_t* sums = sums_at(row, col);
        L* now = rows_.at(row, col);
        L& least = rows_.least(row, col);
        const int stride = job_.cost.stride;
        if (job_.region.contains(from_row, from_col)) {
            const int p2 = penalty(job_.tone->at(row, col), job_.tone->at(from_row, from_col));
            least = Step<kLanes, L>::follow(rows_.at(from_row, from_col),
                                            rows_.least(from_row, from_col), costs, stride,
                                            job_.penalties.p1, p2, now, sums, job_.first);
        } else if (job_.start != nullptr && job_.image.contains(from_row, from_col)) {
            L before_least = 0;
            const L* before = coarse_costs(from_row, from_col, before_least);
            const int p2 = penalty(job_.tone->at(row, col), start_tone(from_row, from_col));
            least = Step<kLanes, L>::follow(before, before_least, costs, stride,
                                            job_.penalties.p1, p2, now, sums, job_.first);
        } else {
            least = Step<kLanes, L>::begin(costs, stride, now, sums, job_.first);
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
void sweep_rows_apart(const SweepJob<L>& job, SweepWorkspace<L>& workspace)
{
    if (!job.spread_over_threads) {
        Sweep<kLanes, L> one(job, workspace);
        for (int row = job.region.row; row < job.region.row_end(); ++row) {
            one.row(row, job.region.col, job.region.col_end());
        }
        return;
    }
    tbb::parallel_for(tbb::blocked_range<int>(job.region.row, job.region.row_end(), 16),
                      [&](const tbb::blocked_range<int>& rows) {
                          SweepWorkspace<L> own;
                          Sweep<kLanes, L> one(job, own);
                          for (int row = rows.begin(); row < rows.end(); ++row) {
                              one.row(row, job.region.col, job.region.col_end());
                          }
                      });
}

// Rows one after the other; the pixels of a row only look at earlier rows, so a long row
// may be shared out. Each part has its own start buffer.
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
