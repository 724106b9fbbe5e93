#pragma once

#include "matcher/kernel.h"
#include "tiling/rect.h"

#include <cstddef>
#include <cstdint>

// What kernels are given: plain structures of numbers and device pointers. Host code fills
// them in; nothing here owns anything.
namespace hsgm::matcher::cuda {

constexpr int kMostDirections = 16;

template <typename T>
HSGM_HOST_DEVICE constexpr T least_of(T a, T b)
{
    return b < a ? b : a;
}
template <typename T>
HSGM_HOST_DEVICE constexpr T most_of(T a, T b)
{
    return a < b ? b : a;
}
HSGM_HOST_DEVICE constexpr int clamped(int value, int least, int most)
{
    return least_of(most_of(value, least), most);
}
/// floor(value / by) for by > 0.
HSGM_HOST_DEVICE constexpr int floor_divided(int value, int by)
{
    return value >= 0 ? value / by : -((-value + by - 1) / by);
}
HSGM_HOST_DEVICE constexpr int ceil_divided(int value, int by)
{
    return -floor_divided(-value, by);
}

/// A tiling::Rect for device code: half-open, in global pixels of a level.
struct Area {
    int row = 0;
    int col = 0;
    int rows = 0;
    int cols = 0;

    Area() = default;
    HSGM_HOST_DEVICE Area(int r, int c, int n_rows, int n_cols)
        : row(r), col(c), rows(n_rows), cols(n_cols)
    {
    }
    explicit Area(const tiling::Rect& rect)
        : row(rect.row), col(rect.col), rows(rect.rows), cols(rect.cols)
    {
    }
    HSGM_HOST_DEVICE int row_end() const { return row + rows; }
    HSGM_HOST_DEVICE int col_end() const { return col + cols; }
    HSGM_HOST_DEVICE bool contains(int r, int c) const
    {
        return r >= row && r < row_end() && c >= col && c < col_end();
    }
    HSGM_HOST_DEVICE std::size_t pixels() const
    {
        return std::size_t(rows) * std::size_t(cols);
    }
};

/// Device pixels of an area, without gaps, addressed in global pixels.
template <typename T>
struct Plane {
    T* data = nullptr;
    Area area;

    HSGM_HOST_DEVICE T& at(int row, int col) const
    {
        return data[std::size_t(row - area.row) * std::size_t(area.cols) +
                    std::size_t(col - area.col)];
    }
};

/// A window of a level, and the disparities searched in it: its stored range.
struct Window {
    Area core;
    int least = 0;
    int count = 0;
};

/// The directions of the paths, as matcher/host/directions.h numbers them.
struct Directions {
    int count = 0;
    int row[kMostDirections] = {};
    int col[kMostDirections] = {};
};

/// Which lines of pixels of a level the paths of the next finer one start from: as
/// matcher/host/level_result.h says of its StartLines.
struct StartGrid {
    int window_px = 0;
    int halo_px = 0;

    HSGM_HOST_DEVICE int pitch() const { return window_px / 2; }
    HSGM_HOST_DEVICE int first(int line, int step) const
    {
        return ceil_divided(line - offset(step), pitch()) * pitch() + offset(step);
    }
    HSGM_HOST_DEVICE bool holds(int line, int step) const
    {
        return step != 0 && first(line, step) == line;
    }
    /// Lines among [begin, end).
    HSGM_HOST_DEVICE int count(int begin, int end, int step) const
    {
        const int line = step == 0 ? end : first(begin, step);
        return line >= end ? 0 : (end - 1 - line) / pitch() + 1;
    }

private:
    HSGM_HOST_DEVICE int offset(int step) const
    {
        return step > 0 ? -halo_px / 2 - 1 : halo_px / 2;
    }
};

/// What a finer level reads of a level: winners, prior, and path costs along the start lines.
/// For every pixel `stride` disparities are kept, from the least one of its window on.
template <typename Cell>
struct LevelStore {
    int rows = 0; ///< of the whole level
    int cols = 0;
    Area area;         ///< the part that is here: whole windows
    int window_px = 0; ///< 0: one window, the image
    Window* windows = nullptr;
    int stride = 0;
    StartGrid grid;
    Directions directions;
    std::int16_t* winner = nullptr;
    std::uint8_t* prior = nullptr;                ///< null where nobody reads it
    Cell* lines = nullptr;                        ///< L - min L
    std::size_t line_begin[kMostDirections] = {}; ///< of a direction's rows, in vectors

    HSGM_HOST_DEVICE const Window& window_at(int row, int col) const
    {
        if (window_px == 0) {
            return windows[0];
        }
        const int across = ceil_divided(area.col_end(), window_px) - area.col / window_px;
        return windows[(row / window_px - area.row / window_px) * across +
                       (col / window_px - area.col / window_px)];
    }
    HSGM_HOST_DEVICE std::size_t pixel(int row, int col) const
    {
        return std::size_t(row - area.row) * std::size_t(area.cols) +
               std::size_t(col - area.col);
    }
    HSGM_HOST_DEVICE const std::uint8_t* prior_at(int row, int col) const
    {
        return prior + pixel(row, col) * std::size_t(stride);
    }
    /// The vector of a pixel on a start row or a start column of direction `d`.
    HSGM_HOST_DEVICE Cell* line_at(int d, int row, int col) const
    {
        const int dr = directions.row[d];
        const int dc = directions.col[d];
        std::size_t vector = line_begin[d];
        if (grid.holds(row, dr)) {
            const int slot = (row - grid.first(area.row, dr)) / grid.pitch();
            vector += std::size_t(slot) * std::size_t(area.cols) + std::size_t(col - area.col);
        } else {
            const int slot = (col - grid.first(area.col, dc)) / grid.pitch();
            vector +=
                std::size_t(grid.count(area.row, area.row_end(), dr)) * std::size_t(area.cols) +
                std::size_t(slot) * std::size_t(area.rows) + std::size_t(row - area.row);
        }
        return lines + vector * std::size_t(stride);
    }
    /// Sets `line_begin`; the vectors that `lines` must hold.
    std::size_t lay_out_lines()
    {
        std::size_t vectors = 0;
        for (int d = 0; d < directions.count; ++d) {
            line_begin[d] = vectors;
            vectors += std::size_t(grid.count(area.row, area.row_end(), directions.row[d])) *
                           std::size_t(area.cols) +
                       std::size_t(grid.count(area.col, area.col_end(), directions.col[d])) *
                           std::size_t(area.rows);
        }
        return vectors;
    }
};

} // namespace hsgm::matcher::cuda
