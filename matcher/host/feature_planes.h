#pragma once

#include "tiling/rect.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace hsgm::matcher::host {

/// What a matching cost reads of each pixel of one image: a few bytes a pixel, plane by
/// plane, and whether the pixel is valid. The planes of a row follow each other, so that a
/// row is `planes + 1` runs of rect.cols bytes.
///
/// Of the right image the runs are mirrored: entry 0 belongs to the last column. Rising
/// disparities of a left pixel then are rising entries, as vectors want them.
///
/// Entries up to kReadBeyond past the end of a run may be read; they mean nothing.
class FeaturePlanes {
public:
    static constexpr std::size_t kReadBeyond = 64;

    FeaturePlanes() = default;
    /// The bytes are not initialised.
    FeaturePlanes(const tiling::Rect& rect, int planes, bool mirrored)
        : rect_(rect), planes_(planes), mirrored_(mirrored),
          data_(new std::uint8_t[std::size_t(planes + 1) * std::size_t(rect.area()) +
                                 kReadBeyond])
    {
    }

    const tiling::Rect& rect() const { return rect_; }
    int planes() const { return planes_; }

    /// The run of a plane; the one after the last plane is validity, 255 or 0.
    const std::uint8_t* run(int plane, int row) const
    {
        return data_.get() + offset(plane, row);
    }
    const std::uint8_t* validity(int row) const { return run(planes_, row); }

    /// Sets a run from the values of rising columns.
    void write(int plane, int row, const std::uint8_t* values)
    {
        std::uint8_t* to = data_.get() + offset(plane, row);
        if (mirrored_) {
            std::reverse_copy(values, values + rect_.cols, to);
        } else {
            std::copy_n(values, rect_.cols, to);
        }
    }
    void write_validity(int row, const std::uint8_t* values)
    {
        write(planes_, row, values);
        has_gaps_ =
            has_gaps_ || std::find(values, values + rect_.cols, 0) != values + rect_.cols;
    }
    /// Whether a pixel is not valid.
    bool has_gaps() const { return has_gaps_; }

private:
    std::size_t offset(int plane, int row) const
    {
        assert(row >= rect_.row && row < rect_.row_end() && plane <= planes_);
        return (std::size_t(row - rect_.row) * std::size_t(planes_ + 1) + std::size_t(plane)) *
               std::size_t(rect_.cols);
    }

    tiling::Rect rect_;
    int planes_ = 0;
    bool mirrored_ = false;
    bool has_gaps_ = false;
    std::unique_ptr<std::uint8_t[]> data_;
};

} // namespace hsgm::matcher::host
