#pragma once

#include "matcher/host/directions.h"
#include "tiling/disparity_range.h"
#include "tiling/image.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hsgm::matcher::host {

/// Which pixels of a level the paths of the next finer level start from. Windows of that
/// level lie on a grid of `window_px` there, so seen from here every window_px / 2:
///
///        fine window's halo begins
///     . . | o o o o         '.' the line of coarse pixels that paths start from
///     . . | o o o o         'o' coarse pixels under halo and core
///
/// Only these lines of L_r are kept, about 5 % of all.
struct StartLines {
    int window_px;
    int halo_px;

    /// Whether paths of step `step` (of rows, or of columns) start from line `line`.
    bool holds(int line, int step) const
    {
        return step != 0 &&
               tiling::floor_div(line - offset(step), pitch()) * pitch() == line - offset(step);
    }
    /// The first line >= `line` that holds.
    int first(int line, int step) const
    {
        return tiling::ceil_div(line - offset(step), pitch()) * pitch() + offset(step);
    }
    int pitch() const { return window_px / 2; }

private:
    int offset(int step) const { return step > 0 ? -halo_px / 2 - 1 : halo_px / 2; }
};

/// The kept path costs of one block and direction: L_r - min L_r along the start lines.
template <typename L>
class LineStore {
public:
    LineStore(const tiling::Rect& core, Direction direction, StartLines lines, int stride)
        : core_(core), direction_(direction), lines_(lines), stride_(stride),
          first_row_(first(core.row, core.row_end(), direction.row)),
          first_col_(first(core.col, core.col_end(), direction.col))
    {
        const int rows = count(first_row_, core.row_end());
        const int cols = count(first_col_, core.col_end());
        row_values_ = std::size_t(rows) * std::size_t(core.cols) * std::size_t(stride);
        values_.resize(row_values_ +
                       std::size_t(cols) * std::size_t(core.rows) * std::size_t(stride) +
                       kReadBeyond);
    }

    bool holds_row(int row) const { return lines_.holds(row, direction_.row); }
    bool holds_col(int col) const { return lines_.holds(col, direction_.col); }

    /// The columns of the core for which holds_col is true: from first_col on, one a pitch.
    int first_col() const { return first_col_; }
    int col_pitch() const { return lines_.pitch(); }

    std::int64_t bytes() const { return static_cast<std::int64_t>(values_.size() * sizeof(L)); }
    /// The vector of a pixel for which holds_row or holds_col is true.
    L* at(int row, int col) { return values_.data() + index(row, col); }
    const L* at(int row, int col) const { return values_.data() + index(row, col); }

private:
    /// Whole vectors are read at the end of the last pixel.
    static constexpr std::size_t kReadBeyond = 64;

    int first(int begin, int end, int step) const
    {
        return step == 0 ? end : lines_.first(begin, step);
    }
    int count(int first, int end) const
    {
        return first >= end ? 0 : (end - 1 - first) / lines_.pitch() + 1;
    }
    std::size_t index(int row, int col) const
    {
        // Rows of the core that hold lie whole pitches from the first one.
        const int slot_row = (row - first_row_) / lines_.pitch();
        if (row >= first_row_ && slot_row * lines_.pitch() == row - first_row_) {
            return std::size_t(slot_row * core_.cols + col - core_.col) * std::size_t(stride_);
        }
        const int slot = (col - first_col_) / lines_.pitch();
        return row_values_ +
               std::size_t(slot * core_.rows + row - core_.row) * std::size_t(stride_);
    }

    tiling::Rect core_;
    Direction direction_;
    StartLines lines_;
    int stride_;
    int first_row_; ///< the first that holds; the core's end where none does
    int first_col_;
    std::size_t row_values_ = 0;
    std::vector<L> values_;
};

/// What the finer level reads of one window (or of a level solved whole).
template <typename L>
struct BlockResult {
    tiling::Rect core;
    tiling::DisparityRange range;    ///< the disparities searched
    int stride = 0;                  ///< elements kept for a pixel: padded_count(range.count())
    std::vector<std::uint8_t> prior; ///< q of every core pixel; empty where nobody reads it
    std::vector<LineStore<L>> lines; ///< one for each direction

    const std::uint8_t* prior_at(int row, int col) const
    {
        return prior.data() + offset(row, col);
    }
    std::uint8_t* prior_at(int row, int col) { return prior.data() + offset(row, col); }

private:
    std::size_t offset(int row, int col) const
    {
        return (std::size_t(row - core.row) * std::size_t(core.cols) +
                std::size_t(col - core.col)) *
               std::size_t(stride);
    }
};

/// The blocks of one level that cover `windows`, in rows.
template <typename L>
struct LevelResult {
    tiling::Size size;    ///< of the whole level
    tiling::Rect windows; ///< covered part, whole windows clipped to the image
    int window_px = 0;    ///< 0: one block
    std::vector<BlockResult<L>> blocks;
    tiling::Patch<std::int16_t> winners; ///< of `windows`
    tiling::Patch<std::int16_t> medians; ///< of the winners (window_range.h); where pruning

    const BlockResult<L>& block_at(int row, int col) const
    {
        if (window_px == 0) {
            return blocks.front();
        }
        const int cols =
            tiling::ceil_div(windows.col_end(), window_px) - windows.col / window_px;
        const int block_row = row / window_px - windows.row / window_px;
        const int block_col = col / window_px - windows.col / window_px;
        return blocks[static_cast<std::size_t>(block_row * cols + block_col)];
    }
};

} // namespace hsgm::matcher::host
