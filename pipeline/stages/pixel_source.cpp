#include "pipeline/stages/pixel_source.h"

#include <algorithm>

namespace hsgm::pipeline {

namespace {

/// Rows to read at a time: whole blocks, about 16 MiB of doubles.
int strip_rows(const io::RasterSource& source)
{
    constexpr std::int64_t kStripBytes = 16 << 20;
    const tiling::Size size = source.size();
    const std::int64_t row_bytes = std::int64_t{size.cols} * 8;
    const int fitting =
        static_cast<int>(std::clamp<std::int64_t>(kStripBytes / row_bytes, 1, size.rows));
    const int block = std::max(source.block_size().rows, 1);
    // Compressed blocks are decoded as a whole: a strip of less than one decodes it again
    // and again unless GDAL's cache holds a row of them.
    return block <= fitting ? fitting / block * block : fitting;
}

} // namespace

std::vector<tiling::Rect> FileSource::reading_windows() const
{
    const tiling::Size size = raster_.size();
    const int rows = strip_rows(raster_);
    std::vector<tiling::Rect> windows;
    for (int row = 0; row < size.rows; row += rows) {
        windows.push_back({row, 0, std::min(rows, size.rows - row), size.cols});
    }
    return windows;
}

} // namespace hsgm::pipeline
