#pragma once

#include <algorithm>
#include <cstdint>

namespace hsgm::tiling {

/// Width and height of a raster, in pixels.
struct Size {
    int rows = 0;
    int cols = 0;

    std::int64_t area() const { return std::int64_t{rows} * cols; }
    bool operator==(const Size&) const = default;
};

/// A half-open rectangle of pixels, [row, row + rows) x [col, col + cols), in the
/// global pixel coordinates of its pyramid level. May reach outside the image;
/// `intersect` with the image's own rectangle clips it.
struct Rect {
    int row = 0;
    int col = 0;
    int rows = 0;
    int cols = 0;

    int row_end() const { return row + rows; }
    int col_end() const { return col + cols; }
    bool empty() const { return rows <= 0 || cols <= 0; }
    Size size() const { return {rows, cols}; }
    std::int64_t area() const { return empty() ? 0 : std::int64_t{rows} * cols; }

    bool contains(int r, int c) const
    {
        return r >= row && r < row_end() && c >= col && c < col_end();
    }
    bool contains(const Rect& other) const
    {
        return other.empty() || (other.row >= row && other.row_end() <= row_end() &&
                                 other.col >= col && other.col_end() <= col_end());
    }
    bool operator==(const Rect&) const = default;
};

inline Rect rect_of(Size size)
{
    return {0, 0, size.rows, size.cols};
}

/// The rectangle between two corners; `row_end` and `col_end` are exclusive.
inline Rect rect_between(int row, int col, int row_end, int col_end)
{
    return {row, col, row_end - row, col_end - col};
}

/// The common part of two rectangles; empty (0 x 0 at a's corner) where they are apart.
inline Rect intersect(const Rect& a, const Rect& b)
{
    const int row = std::max(a.row, b.row);
    const int col = std::max(a.col, b.col);
    const int row_end = std::min(a.row_end(), b.row_end());
    const int col_end = std::min(a.col_end(), b.col_end());
    if (row_end <= row || col_end <= col) {
        return {a.row, a.col, 0, 0};
    }
    return rect_between(row, col, row_end, col_end);
}

/// The smallest rectangle that holds both; an empty one adds nothing.
inline Rect unite(const Rect& a, const Rect& b)
{
    if (a.empty()) {
        return b;
    }
    if (b.empty()) {
        return a;
    }
    return rect_between(std::min(a.row, b.row), std::min(a.col, b.col),
                        std::max(a.row_end(), b.row_end()), std::max(a.col_end(), b.col_end()));
}

/// Grows a rectangle by `px` pixels on all four sides.
inline Rect expand(const Rect& r, int px)
{
    return {r.row - px, r.col - px, r.rows + 2 * px, r.cols + 2 * px};
}

/// floor(a / b) for b > 0, also for negative a (C++ division truncates).
constexpr int floor_div(int a, int b)
{
    return a >= 0 ? a / b : -((-a + b - 1) / b);
}

/// ceil(a / b) for b > 0.
constexpr int ceil_div(int a, int b)
{
    return -floor_div(-a, b);
}

/// Half the size, rounded up: the size of the next coarser pyramid level.
inline Size halve(Size size)
{
    return {(size.rows + 1) / 2, (size.cols + 1) / 2};
}

/// The coarser pixels that hold at least one pixel of `r`: pixel p lies in floor(p / 2).
inline Rect halve(const Rect& r)
{
    if (r.empty()) {
        return {floor_div(r.row, 2), floor_div(r.col, 2), 0, 0};
    }
    return rect_between(floor_div(r.row, 2), floor_div(r.col, 2),
                        floor_div(r.row_end() - 1, 2) + 1, floor_div(r.col_end() - 1, 2) + 1);
}

/// Grows `r` to whole cells of a grid of `cell` pixels, anchored at the global origin.
inline Rect round_out(const Rect& r, int cell)
{
    if (r.empty()) {
        return r;
    }
    return rect_between(floor_div(r.row, cell) * cell, floor_div(r.col, cell) * cell,
                        ceil_div(r.row_end(), cell) * cell, ceil_div(r.col_end(), cell) * cell);
}

} // namespace hsgm::tiling
