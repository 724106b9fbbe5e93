#include "matcher/host/window_paths.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matcher/host/window_paths.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After Highway: compiled once for every target.
#include "matcher/host/window_step-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hsgm::matcher::host::HWY_NAMESPACE {

// Rows followed side by side by the path along them: each pixel waits for the one before.
constexpr int kRowsAlong = 4;
// What a thread gets of a row that is shared out.
constexpr int kSharedBytes = 32768;

// One path that comes from the row before. Its costs live in one slot for each pixel of a
// row; a slot's new costs replace those of its predecessor, so diagonals move by one slot a
// row.
struct ApartPath {
    Direction r{};
    std::size_t number = 0;
    tiling::Rect region;
    int travelled = 0; // rows since the path's first
    std::uint8_t* values = nullptr;
    std::uint8_t* least = nullptr;

    std::size_t slot(int col) const
    {
        const int moved = r.col > 0 ? region.rows - 1 - travelled : r.col < 0 ? travelled : 0;
        return std::size_t(col - region.col + moved);
    }
};

// Half of a window's paths: those that travel down, or those that travel up.
template <int kLanes, int kVectors>
class Pass {
    using Steps = WindowStep<kLanes, kVectors>;

public:
    Pass(const WindowJob& job, WindowWorkspace& workspace, bool down)
        : job_(job), stride_(job.cost.stride), pitch_(std::size_t(stride_) + kSlotGuard),
          down_(down), steps_(stride_, job.p1)
    {
        const auto all =
            directions(job.paths).first(std::size_t(std::min(job.paths, kWindowPaths)));
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Direction r = all[i];
            if (r.row == 0 && (r.col > 0) == down) {
                add_along(r, i, workspace);
            } else if (r.row != 0 && (r.row > 0) == down) {
                add_apart(r, i, workspace);
            }
        }
        start_ = workspace.start.need(2 * std::size_t(stride_) + 256);
    }

    void run()
    {
        const tiling::Rect& core = job_.core;
        if (apart_count_ > 0) {
            const tiling::Rect& region = apart_[0].region;
            for (int i = 0; i < region.rows - core.rows; ++i) {
                const int row = down_ ? region.row + i : region.row_end() - 1 - i;
                for (int k = 0; k < apart_count_; ++k) {
                    ApartPath& path = apart_[std::size_t(k)];
                    begin_row(path, row);
                    follow(path, row, path.region.col, path.region.col_end());
                    ++path.travelled;
                }
            }
        }
        for (int i = 0; i < core.rows; i += rows_along()) {
            const int rows = std::min(rows_along(), core.rows - i);
            const int first = down_ ? core.row + i : core.row_end() - i - rows;
            follow_along(first, rows);
            for (int k = 0; k < rows; ++k) {
                core_row(down_ ? first + k : first + rows - 1 - k, first);
            }
        }
    }

private:
    static constexpr std::size_t kApart = 3;

    // Rows whose paths along them are kept: all threads have some to follow.
    int rows_along() const { return job_.spread_over_threads ? kSharedRows : kRowsAlong; }

    tiling::Rect region_of(Direction r) const
    {
        const int halo = job_.halo_px;
        const tiling::Rect& core = job_.core;
        return intersect(tiling::rect_between(core.row - (r.row > 0 ? halo : 0),
                                              core.col - (r.col > 0 ? halo : 0),
                                              core.row_end() + (r.row < 0 ? halo : 0),
                                              core.col_end() + (r.col < 0 ? halo : 0)),
                         job_.image);
    }

    void add_along(Direction r, std::size_t number, WindowWorkspace& workspace)
    {
        along_direction_ = r;
        along_number_ = number;
        along_region_ = region_of(r);
        // One slot before the first pixel holds its predecessor.
        along_pitch_ = pitch_ * std::size_t(along_region_.cols + 1) + kSlotGuard;
        along_ = workspace.along.need(along_pitch_ * std::size_t(rows_along()) + kReadBeyond);
        for (int k = 0; k < rows_along(); ++k) {
            guard(along_ + std::size_t(k) * along_pitch_, along_region_.cols + 1);
        }
    }

    void add_apart(Direction r, std::size_t number, WindowWorkspace& workspace)
    {
        const auto k = std::size_t(apart_count_++);
        ApartPath& path = apart_[k];
        path.r = r;
        path.number = number;
        path.region = region_of(r);
        const int slots = path.region.cols + (r.col != 0 ? path.region.rows - 1 : 0);
        path.values =
            workspace.apart[k].need(pitch_ * std::size_t(slots) + kSlotGuard + kReadBeyond);
        path.least = workspace.apart_least[k].need(std::size_t(slots));
        guard(path.values, slots);
        path.values += kSlotGuard;
    }

    // Puts "infinitely dear" between the slots.
    void guard(std::uint8_t* values, int slots) const
    {
        for (int s = 0; s <= slots; ++s, values += pitch_) {
            std::fill_n(values, kSlotGuard, std::uint8_t{255});
        }
    }

    // Prepares the predecessors of the row's pixels where the path enters its region.
    void begin_row(ApartPath& path, int row)
    {
        const tiling::Rect& region = path.region;
        if (path.travelled == 0) {
            for (int col = region.col; col < region.col_end(); ++col) {
                enter(path, row, col);
            }
        } else if (path.r.col != 0) {
            enter(path, row, path.r.col > 0 ? region.col : region.col_end() - 1);
        }
    }
    void enter(ApartPath& path, int row, int col)
    {
        const std::size_t slot = path.slot(col);
        path.least[slot] = start_costs(row - path.r.row, col - path.r.col, path.number,
                                       path.values + slot * pitch_);
    }

    // The costs at a predecessor outside the region, and the least of them (eq. 2). Outside
    // the image: zero, which makes L = C.
    std::uint8_t start_costs(int row, int col, std::size_t number, std::uint8_t* out)
    {
        if (job_.start == nullptr || !job_.image.contains(row, col)) {
            std::fill_n(out, stride_, std::uint8_t{0});
            return 0;
        }
        const int r = row / 2;
        const int c = col / 2;
        if (block_ == nullptr || !block_->core.contains(r, c)) {
            block_ = &job_.start->coarser->block_at(r, c);
        }
        return spread_start(block_->lines[number].at(r, c), block_->range, job_.cost.range,
                            static_cast<std::uint8_t>(job_.start->unsearched), stride_, start_,
                            out);
    }

    // Pixels of a halo: the path alone, no sums.
    void follow(ApartPath& path, int row, int col, int end)
    {
        if (col >= end) {
            return;
        }
        const std::size_t slot = path.slot(col);
        std::uint8_t* values = path.values + slot * pitch_;
        std::uint8_t* least = path.least + slot;
        const std::uint8_t* costs = job_.cost.at(row, col);
        const std::uint8_t* p2 = job_.penalties->at(path.r, row, col);
        for (int i = 0; i < end - col; ++i, values += pitch_, costs += stride_) {
            least[i] = steps_.follow(values, least[i], p2[i], costs, values);
        }
    }

    void core_row(int row, int first_along)
    {
        const tiling::Rect& core = job_.core;
        for (int k = 0; k < apart_count_; ++k) {
            ApartPath& path = apart_[std::size_t(k)];
            begin_row(path, row);
            follow(path, row, path.region.col, core.col);
            follow(path, row, core.col_end(), path.region.col_end());
        }
        const auto part = [&](int col, int cols) {
            down_ ? sum_row<true>(row, col, cols, row - first_along)
                  : sum_row<false>(row, col, cols, row - first_along);
        };
        if (job_.spread_over_threads) {
            tbb::parallel_for(tbb::blocked_range<int>(0, core.cols, kSharedBytes / stride_ + 1),
                              [&](const tbb::blocked_range<int>& cols) {
                                  part(core.col + cols.begin(), int(cols.size()));
                              });
        } else {
            part(core.col, core.cols);
        }
        for (int k = 0; k < apart_count_; ++k) {
            keep_apart(apart_[std::size_t(k)], row);
            ++apart_[std::size_t(k)].travelled;
        }
    }

    // Pixels of a row of the core; the path along it is number `along` of those followed.
    template <bool kFirst>
    void sum_row(int row, int col, int cols, int along)
    {
        const tiling::Rect& core = job_.core;
        SumRow sum;
        sum.along = along_at(along, col);
        sum.along_step = along_direction_.col * std::ptrdiff_t(pitch_);
        sum.pitch = pitch_;
        sum.costs = job_.cost.at(row, col);
        sum.sums = job_.sums + (std::size_t(row - core.row) * std::size_t(core.cols) +
                                std::size_t(col - core.col)) *
                                   std::size_t(stride_);
        sum.cols = cols;
        std::array<StepPath, kApart> paths;
        for (int k = 0; k < apart_count_; ++k) {
            const ApartPath& path = apart_[std::size_t(k)];
            const std::size_t slot = path.slot(col);
            paths[std::size_t(k)] = {path.values + slot * pitch_, path.least + slot,
                                     job_.penalties->at(path.r, row, col)};
        }
        switch (apart_count_) {
        case 3:
            return steps_.template sum_row<kFirst, 3>(sum, paths);
        case 1:
            return steps_.template sum_row<kFirst, 1>(sum, paths);
        default:
            return steps_.template sum_row<kFirst, 0>(sum, paths);
        }
    }

    // The slot of the pixel in the row `k` of those followed along.
    std::uint8_t* along_at(int k, int col)
    {
        const int travelled = along_direction_.col > 0 ? col - along_region_.col
                                                       : along_region_.col_end() - 1 - col;
        return along_ + std::size_t(k) * along_pitch_ + std::size_t(travelled + 1) * pitch_ +
               kSlotGuard;
    }

    // The paths along `rows` rows from `first` on.
    void follow_along(int first, int rows)
    {
        const auto some = [&](int k) {
            if (k + kRowsAlong <= rows) {
                along_rows<kRowsAlong>(first + k, k);
                return;
            }
            for (; k < rows; ++k) {
                along_rows<1>(first + k, k);
            }
        };
        if (job_.spread_over_threads) {
            tbb::parallel_for(0, rows, kRowsAlong, some);
        } else {
            some(0);
        }
    }

    // kRows rows from `first` on, kept from number `k` on.
    template <int kRows>
    void along_rows(int first, int k)
    {
        const Direction r = along_direction_;
        const tiling::Rect& region = along_region_;
        const int begin = r.col > 0 ? region.col : region.col_end() - 1;
        std::array<std::uint8_t*, kRows> values;
        std::array<std::uint8_t, kRows> least;
        std::array<const std::uint8_t*, kRows> costs;
        std::array<const std::uint8_t*, kRows> p2;
        for (std::size_t n = 0; n < kRows; ++n) {
            const int row = first + int(n);
            values[n] = along_at(k + int(n), begin) - pitch_;
            least[n] = start_costs(row, begin - r.col, along_number_, values[n]);
            costs[n] = job_.cost.at(row, begin);
            p2[n] = job_.penalties->at(r, row, begin);
        }
        for (int i = 0; i < region.cols; ++i) {
            for (std::size_t n = 0; n < kRows; ++n) {
                const std::uint8_t* before = values[n];
                values[n] += pitch_;
                least[n] = steps_.follow(before, least[n], *p2[n], costs[n], values[n]);
                costs[n] += r.col * stride_;
                p2[n] += r.col;
            }
            keep_along<kRows>(first, begin + i * r.col, values, least);
        }
    }

    template <std::size_t kRows>
    void keep_along(int first, int col, const std::array<std::uint8_t*, kRows>& values,
                    const std::array<std::uint8_t, kRows>& least)
    {
        if (job_.lines == nullptr || col < job_.core.col || col >= job_.core.col_end()) {
            return;
        }
        auto& lines = (*job_.lines)[along_number_];
        if (lines.holds_col(col)) {
            for (std::size_t n = 0; n < kRows; ++n) {
                keep(values[n], least[n], lines.at(first + int(n), col));
            }
        }
    }

    void keep_apart(const ApartPath& path, int row)
    {
        if (job_.lines == nullptr) {
            return;
        }
        auto& lines = (*job_.lines)[path.number];
        const tiling::Rect& core = job_.core;
        if (lines.holds_row(row)) {
            for (int col = core.col; col < core.col_end(); ++col) {
                keep_slot(path, col, lines.at(row, col));
            }
            return;
        }
        for (int col = lines.first_col(); col < core.col_end(); col += lines.col_pitch()) {
            keep_slot(path, col, lines.at(row, col));
        }
    }
    void keep_slot(const ApartPath& path, int col, std::uint8_t* to) const
    {
        const std::size_t slot = path.slot(col);
        keep(path.values + slot * pitch_, path.least[slot], to);
    }
    void keep(const std::uint8_t* values, std::uint8_t least, std::uint8_t* to) const
    {
        for (int i = 0; i < stride_; ++i) {
            to[i] = static_cast<std::uint8_t>(values[i] - least);
        }
    }

    const WindowJob& job_;
    int stride_;
    std::size_t pitch_;
    bool down_;
    Steps steps_;
    std::array<ApartPath, kApart> apart_;
    int apart_count_ = 0;
    Direction along_direction_{};
    std::size_t along_number_ = 0;
    tiling::Rect along_region_;
    std::size_t along_pitch_ = 0;
    std::uint8_t* along_ = nullptr;
    // Where paths start, which levels that are shared out have none of.
    const BlockResult<std::uint8_t>* block_ = nullptr; // of the last start
    std::uint8_t* start_ = nullptr;
};

template <int kLanes, int kVectors>
void both_passes(const WindowJob& job, WindowWorkspace& workspace)
{
    Pass<kLanes, kVectors>(job, workspace, true).run();
    Pass<kLanes, kVectors>(job, workspace, false).run();
}

// Vectors for each pixel: a number known to the compiler keeps a pixel's sums in registers.
void in_registers(const WindowJob& job, WindowWorkspace& workspace, int vectors)
{
    switch (vectors) {
    case 1:
        return both_passes<32, 1>(job, workspace);
    case 2:
        return both_passes<32, 2>(job, workspace);
    case 3:
        return both_passes<32, 3>(job, workspace);
    case 4:
        return both_passes<32, 4>(job, workspace);
    case 5:
        return both_passes<32, 5>(job, workspace);
    case 6:
        return both_passes<32, 6>(job, workspace);
    case 7:
        return both_passes<32, 7>(job, workspace);
    case 8:
        return both_passes<32, 8>(job, workspace);
    default:
        return both_passes<32, 0>(job, workspace);
    }
}

// Vectors of 32 bytes measure faster than longer ones, as long as the sums fit the
// registers: fewer of them cross a cache line.
void all_paths(const WindowJob& job, WindowWorkspace& workspace)
{
    if (job.cost.stride % 32 != 0) {
        both_passes<16, 1>(job, workspace);
    } else if (job.cost.stride % 64 == 0 && job.cost.stride > 256) {
        both_passes<64, 0>(job, workspace);
    } else {
        const hn::CappedTag<std::uint8_t, 32> d;
        in_registers(job, workspace, job.cost.stride / static_cast<int>(hn::Lanes(d)));
    }
}

} // namespace hsgm::matcher::host::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hsgm::matcher::host {

HWY_EXPORT(all_paths);

void window_paths(const WindowJob& job, WindowWorkspace& workspace)
{
    HWY_DYNAMIC_DISPATCH(all_paths)(job, workspace);
}

std::int64_t whole_level_path_bytes(tiling::Size size, int stride)
{
    const std::int64_t slot = stride + 16 + 1; // costs, guard, least
    const std::int64_t apart = 2 * (std::int64_t{size.rows} + size.cols) + size.cols;
    return (apart + std::int64_t{kSharedRows} * (size.cols + 1)) * slot;
}

} // namespace hsgm::matcher::host
#endif
