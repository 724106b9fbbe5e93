#pragma once

#include "io/pixel_type.h"
#include "io/raster_source.h"
#include "tiling/image.h"
#include "tiling/rect.h"

#include <string>
#include <utility>
#include <vector>

namespace hsgm::pipeline {

/// A grey image that the stages read window by window: a file as it is, or one resampled on
/// the way. One thread at a time.
class PixelSource {
public:
    virtual ~PixelSource() = default;
    virtual tiling::Size size() const = 0;
    /// What the values are worth: whole numbers of some width, or real ones.
    virtual io::PixelType pixel_type() const = 0;
    /// For people.
    virtual std::string description() const = 0;
    /// Windows that cover the image once, each read with little waste; a few megabytes each.
    virtual std::vector<tiling::Rect> reading_windows() const = 0;
    /// Reads a window inside the image into a view of its size; NaN where a pixel has no value.
    virtual void read(const tiling::Rect& window, tiling::ImageView<double> values) = 0;
};

/// The pixels of a file.
class FileSource final : public PixelSource {
public:
    explicit FileSource(io::RasterSource raster) : raster_(std::move(raster)) {}

    tiling::Size size() const override { return raster_.size(); }
    io::PixelType pixel_type() const override { return raster_.pixel_type(); }
    std::string description() const override { return raster_.description(); }
    std::vector<tiling::Rect> reading_windows() const override;
    void read(const tiling::Rect& window, tiling::ImageView<double> values) override
    {
        raster_.read(window, values);
    }

private:
    io::RasterSource raster_;
};

} // namespace hsgm::pipeline
