#include "pipeline/stages/raster_strips.h"

#include "io/error.h"
#include "pipeline/error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <filesystem>

namespace hsgm::pipeline {

namespace {

using tiling::ImageView;
using tiling::Rect;
using tiling::Size;

// What one thread renders at a time.
constexpr Size kTask{64, 512};

// Calls render(part) for parts that cover the strip, side by side.
template <typename Render>
void in_parallel(const Rect& strip, Render render)
{
    const int across = tiling::ceil_div(strip.cols, kTask.cols);
    const int down = tiling::ceil_div(strip.rows, kTask.rows);
    tbb::parallel_for(0, across * down, [&](int task) {
        const Rect part{strip.row + task / across * kTask.rows,
                        strip.col + task % across * kTask.cols, kTask.rows, kTask.cols};
        render(tiling::intersect(part, strip));
    });
}

} // namespace

template <typename T>
void write_computed(const std::string& path, Size size, io::RasterOptions options,
                    const RenderPart<T>& render)
{
    io::GeoTiffWriter writer(path, size, io::pixel_type_of<T>(), std::move(options));
    // Whole rows of stored blocks, so that no block waits for its lower half.
    const int strip_rows = std::max(writer.block_size().rows, kTask.rows);
    for (int row = 0; row < size.rows; row += strip_rows) {
        check_stop();
        const Rect strip{row, 0, std::min(strip_rows, size.rows - row), size.cols};
        tiling::Patch<T> pixels(strip);
        in_parallel(strip, [&](const Rect& part) { render(part, pixels.view_of(part)); });
        writer.write<T>(strip, pixels.pixels.view());
    }
    writer.finish();
}

template void write_computed<float>(const std::string&, Size, io::RasterOptions,
                                    const RenderPart<float>&);
template void write_computed<std::uint8_t>(const std::string&, Size, io::RasterOptions,
                                           const RenderPart<std::uint8_t>&);
template void write_computed<std::uint16_t>(const std::string&, Size, io::RasterOptions,
                                            const RenderPart<std::uint16_t>&);

void write_gray(const std::string& path, Size size, int bits, io::RasterOptions options,
                const RenderPart<std::uint16_t>& render)
{
    if (bits > 8) {
        write_computed<std::uint16_t>(path, size, std::move(options), render);
        return;
    }
    const auto narrow = [&](const Rect& part, ImageView<std::uint8_t> out) {
        tiling::Image<std::uint16_t> wide(part.size());
        render(part, wide.view());
        for (int r = 0; r < part.rows; ++r) {
            std::transform(wide.row(r), wide.row(r) + part.cols, out.row(r),
                           [](std::uint16_t v) { return static_cast<std::uint8_t>(v); });
        }
    };
    write_computed<std::uint8_t>(path, size, std::move(options), narrow);
}

void make_output_folder(const std::string& folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw io::StorageError(folder + ": cannot make this folder: " + error.message());
    }
}

} // namespace hsgm::pipeline
