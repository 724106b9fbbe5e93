#pragma once

#include "tiling/page_allocator.h"
#include "tiling/rect.h"

#include <cassert>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

namespace hsgm::tiling {

/// Borrowed pixels: pointer, size and row stride (in elements). Trivially copyable; the
/// owner must outlive it. Indexed (row, col) from the view's own corner.
template <typename T>
class ImageView {
public:
    ImageView() = default;
    ImageView(T* data, Size size, std::ptrdiff_t stride)
        : data_(data), size_(size), stride_(stride)
    {
    }
    /// A view of mutable pixels serves where constant ones are asked for.
    template <typename U>
    requires std::is_same_v<const U, T> ImageView(const ImageView<U>& other)
        : data_(other.data()), size_(other.size()), stride_(other.stride())
    {
    }

    int rows() const { return size_.rows; }
    int cols() const { return size_.cols; }
    Size size() const { return size_; }
    std::ptrdiff_t stride() const { return stride_; }
    T* data() const { return data_; }

    T* row(int r) const
    {
        assert(r >= 0 && r < size_.rows);
        return data_ + r * stride_;
    }
    T& operator()(int r, int c) const
    {
        assert(c >= 0 && c < size_.cols);
        return row(r)[c];
    }
    std::span<T> row_span(int r) const
    {
        return {row(r), static_cast<std::size_t>(size_.cols)};
    }

    /// The part of this view that `r` (in the view's own coordinates) covers.
    ImageView part(const Rect& r) const
    {
        assert(rect_of(size_).contains(r));
        return {data_ + r.row * stride_ + r.col, r.size(), stride_};
    }

private:
    T* data_ = nullptr;
    Size size_{};
    std::ptrdiff_t stride_ = 0;
};

/// Owned pixels, rows stored one after the other without gaps.
template <typename T>
class Image {
public:
    Image() = default;
    explicit Image(Size size, T fill = T{})
        : size_(size), pixels_(static_cast<std::size_t>(size.area()), fill)
    {
    }

    int rows() const { return size_.rows; }
    int cols() const { return size_.cols; }
    Size size() const { return size_; }
    T* data() { return pixels_.data(); }
    const T* data() const { return pixels_.data(); }

    T& operator()(int r, int c) { return pixels_[index(r, c)]; }
    const T& operator()(int r, int c) const { return pixels_[index(r, c)]; }
    T* row(int r) { return pixels_.data() + index(r, 0); }
    const T* row(int r) const { return pixels_.data() + index(r, 0); }

    ImageView<T> view() { return {pixels_.data(), size_, size_.cols}; }
    ImageView<const T> view() const { return {pixels_.data(), size_, size_.cols}; }
    operator ImageView<T>() { return view(); }
    operator ImageView<const T>() const { return view(); }

    std::span<const T> pixels() const { return pixels_; }
    bool operator==(const Image&) const = default;

private:
    std::size_t index(int r, int c) const
    {
        assert(r >= 0 && r < size_.rows && c >= 0 && c <= size_.cols);
        return static_cast<std::size_t>(r) * static_cast<std::size_t>(size_.cols) +
               static_cast<std::size_t>(c);
    }

    Size size_{};
    std::vector<T, PageAllocator<T>> pixels_;
};

/// Pixels of a part of a larger raster, addressed by the raster's global (row, col).
/// `rect` says which part; reading outside it is a bug.
template <typename T>
struct Patch {
    Rect rect;
    Image<T> pixels;

    Patch() = default;
    explicit Patch(const Rect& r, T fill = T{}) : rect(r), pixels(r.size(), fill) {}

    T& at(int row, int col)
    {
        assert(rect.contains(row, col));
        return pixels(row - rect.row, col - rect.col);
    }
    const T& at(int row, int col) const
    {
        assert(rect.contains(row, col));
        return pixels(row - rect.row, col - rect.col);
    }
    /// The pixels of `part` (global coordinates, inside `rect`).
    ImageView<const T> view_of(const Rect& part) const
    {
        assert(rect.contains(part));
        return pixels.view().part(
            {part.row - rect.row, part.col - rect.col, part.rows, part.cols});
    }
    ImageView<T> view_of(const Rect& part)
    {
        assert(rect.contains(part));
        return pixels.view().part(
            {part.row - rect.row, part.col - rect.col, part.rows, part.cols});
    }
};

} // namespace hsgm::tiling
