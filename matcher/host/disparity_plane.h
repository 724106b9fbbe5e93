#pragma once

#include "matcher/matcher.h"
#include "tiling/image.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace hsgm::matcher::host {

/// In a DisparityPlane: no value here. Disparities lie within 16000 px, so no difference
/// between a hole and a value is ever small.
constexpr std::int32_t kHole = std::int32_t{1} << 30;
/// What `winner_row` makes of a hole; no less far away.
constexpr std::int16_t kNoWinner = 32767;

/// Disparities in 1/256 px of a part of the left image, addressed by global (row, col), with
/// a frame of holes on all sides: neighbourhoods need not look for borders.
class DisparityPlane {
public:
    /// Rows above and below that may be read.
    static constexpr int kFrameRows = 5;
    /// Columns before and behind that may be read; so vectors may end anywhere.
    static constexpr int kFrameCols = 64;

    /// What lies inside the frame must be written before it is read.
    explicit DisparityPlane(const tiling::Rect& rect)
        : rect_(rect), stride_(rect.cols + 2 * kFrameCols),
          pixels_(std::make_unique_for_overwrite<std::int32_t[]>(
              static_cast<std::size_t>(bytes(rect.size())) / sizeof(std::int32_t)))
    {
        for (int row = rect.row - kFrameRows; row < rect.row_end() + kFrameRows; ++row) {
            const bool inside = row >= rect.row && row < rect.row_end();
            std::fill_n(at(row, rect.col - kFrameCols), inside ? kFrameCols : stride_, kHole);
            close_row(row);
        }
    }

    const tiling::Rect& rect() const { return rect_; }
    std::int32_t* at(int row, int col) { return pixels_.get() + index(row, col); }
    const std::int32_t* at(int row, int col) const { return pixels_.get() + index(row, col); }
    bool has_value(int row, int col) const { return *at(row, col) != kHole; }

    /// Puts the frame behind the columns of a row in order again, where vectors wrote into it.
    void close_row(int row) { std::fill_n(at(row, rect_.col_end()), kFrameCols, kHole); }

    static std::int64_t bytes(tiling::Size size)
    {
        return tiling::Size{size.rows + 2 * kFrameRows, size.cols + 2 * kFrameCols}.area() *
               static_cast<std::int64_t>(sizeof(std::int32_t));
    }

private:
    std::size_t index(int row, int col) const
    {
        return static_cast<std::size_t>(row - rect_.row + kFrameRows) *
                   static_cast<std::size_t>(stride_) +
               static_cast<std::size_t>(col - rect_.col + kFrameCols);
    }

    tiling::Rect rect_;
    int stride_;
    std::unique_ptr<std::int32_t[]> pixels_;
};

} // namespace hsgm::matcher::host
