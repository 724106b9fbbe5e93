#pragma once

#include "io/geotiff_writer.h"

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

namespace hsgm::pipeline {

/// Several rasters of one size that get their names together.
class RasterGroup {
public:
    explicit RasterGroup(tiling::Size size) : size_(size) {}

    /// The next raster; an empty path: nobody asked for it, and what is written to it is lost.
    void add(const std::filesystem::path& path, io::PixelType type, io::RasterOptions options)
    {
        writers_.push_back(path.empty() ? nullptr
                                        : std::make_unique<io::GeoTiffWriter>(
                                              path.string(), size_, type, std::move(options)));
    }
    template <typename T>
    void write(std::size_t raster, const tiling::Rect& rect, const tiling::Image<T>& pixels)
    {
        if (writers_[raster]) {
            writers_[raster]->write(rect, pixels);
        }
    }
    void finish()
    {
        for (const auto& writer : writers_) {
            if (writer) {
                writer->complete();
            }
        }
        for (const auto& writer : writers_) {
            if (writer) {
                writer->publish();
            }
        }
    }

private:
    tiling::Size size_;
    std::vector<std::unique_ptr<io::GeoTiffWriter>> writers_;
};

} // namespace hsgm::pipeline
