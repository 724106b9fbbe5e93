#include "pipeline/stages/synth_stage.h"

#include "io/error.h"
#include "io/geotiff_writer.h"
#include "pipeline/error.h"
#include "pipeline/synth/renderer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <stdexcept>

namespace hsgm::pipeline {

namespace {

using tiling::ImageView;
using tiling::Rect;

// What one thread renders at a time.
constexpr tiling::Size kTask{64, 512};

synth::Renderer renderer_of(const synth::Scene& scene)
{
    try {
        return synth::Renderer(scene);
    } catch (const std::invalid_argument& refused) {
        throw io::ConfigError(refused.what());
    }
}

void make_folder(const std::string& folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw io::StorageError(folder + ": cannot make this folder: " + error.message());
    }
}

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

// Writes one raster: render(part, pixels) fills any part of it, of pixels T.
template <typename T, typename Render>
void write_raster(const std::string& path, tiling::Size size, io::RasterOptions options,
                  Render render)
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

// The renderer's gray levels, in as few bytes as the scene's bits need.
template <typename Render>
void write_image(const std::string& path, const synth::Scene& scene, Render render)
{
    io::RasterOptions options;
    options.nodata = 0;
    options.band_descriptions = {"gray"};
    if (scene.bits > 8) {
        write_raster<std::uint16_t>(path, scene.size, options, render);
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
    write_raster<std::uint8_t>(path, scene.size, options, narrow);
}

} // namespace

synth::DisparityBounds write_scene(const synth::Scene& scene, const std::string& folder)
{
    const synth::Renderer r = renderer_of(scene);
    make_folder(folder);
    write_image(folder + "/left.tif", scene,
                [&](const Rect& part, auto out) { r.render_left(part, out); });
    write_image(folder + "/right.tif", scene,
                [&](const Rect& part, auto out) { r.render_right(part, out); });
    io::RasterOptions truth;
    truth.band_descriptions = {"disparity x_left - x_right"};
    truth.unit = "pixel";
    write_raster<float>(folder + "/truth_left.tif", scene.size, truth,
                        [&](const Rect& part, auto out) { r.truth_left(part, out); });
    write_raster<float>(folder + "/truth_right.tif", scene.size, truth,
                        [&](const Rect& part, auto out) { r.truth_right(part, out); });
    io::RasterOptions visible;
    visible.band_descriptions = {"255 = visible in both images"};
    write_raster<std::uint8_t>(folder + "/visible_left.tif", scene.size, visible,
                               [&](const Rect& part, auto out) { r.visible_left(part, out); });
    return r.disparity_bounds();
}

} // namespace hsgm::pipeline
