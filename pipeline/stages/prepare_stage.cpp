#include "pipeline/stages/prepare_stage.h"

#include "io/error.h"
#include "matcher/noise.h"
#include "matcher/reduce.h"
#include "pipeline/error.h"
#include "pipeline/stages/pixel_checksum.h"
#include "pipeline/stages/pixel_mapping.h"
#include "tiling/pyramid.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <mutex>

namespace hsgm::pipeline {

namespace {

using Raster = io::ScratchRaster<std::uint16_t>;
using tiling::Patch;
using tiling::Rect;
using tiling::Size;

std::vector<Raster> open_levels(const std::filesystem::path& folder, const std::string& name,
                                const std::vector<Size>& sizes, io::ScratchLife life)
{
    std::vector<Raster> levels;
    levels.reserve(sizes.size());
    for (std::size_t k = 0; k < sizes.size(); ++k) {
        levels.emplace_back(folder, name + std::to_string(k) + ".raw", sizes[k],
                            std::uint16_t{0}, life);
    }
    return levels;
}

// Copies a source into level 0 and returns the counts of its valid pixels.
std::unique_ptr<PixelHistogram> copy_full_resolution(PixelSource& source,
                                                     const PixelMapping& mapping,
                                                     Raster& level0, PixelChecksum& checksum)
{
    auto histogram = std::make_unique<PixelHistogram>();
    tiling::Image<double> values;
    tiling::Image<std::uint16_t> pixels;
    for (const Rect& window : source.reading_windows()) {
        check_stop();
        if (values.size() != window.size()) {
            values = tiling::Image<double>(window.size());
            pixels = tiling::Image<std::uint16_t>(window.size());
        }
        source.read(window, values);
        checksum.add(values.view());
        std::transform(values.pixels().begin(), values.pixels().end(), pixels.data(), mapping);
        for (const std::uint16_t pixel : pixels.pixels()) {
            ++(*histogram)[pixel];
        }
        level0.write(window, pixels.view());
    }
    (*histogram)[matcher::kNodataPixel] = 0;
    return histogram;
}

Patch<std::uint16_t> read_part(const Raster& raster, const Rect& part)
{
    Patch<std::uint16_t> patch(part);
    raster.read(part, patch.pixels.view());
    return patch;
}

void reduce_level(const Raster& fine, Raster& coarse)
{
    const Size size = coarse.size();
    const int rows = std::clamp((1 << 20) / std::max(size.cols, 1), 1, 256);
    tbb::parallel_for(
        tbb::blocked_range<int>(0, tiling::ceil_div(size.rows, rows), 1),
        [&](const tbb::blocked_range<int>& strips) {
            for (int i = strips.begin(); i < strips.end(); ++i) {
                check_stop();
                const Rect part = intersect({i * rows, 0, rows, size.cols}, rect_of(size));
                Patch<std::uint16_t> taps(
                    intersect(tiling::pyramid_taps(part), rect_of(fine.size())));
                fine.read(taps.rect, taps.pixels.view());
                tiling::Image<std::uint16_t> reduced(part.size());
                matcher::reduce(taps, fine.size(), part, reduced);
                coarse.write(part, reduced.view());
            }
        });
}

// Strips hold whole rows of blocks, so that it does not matter how long they are.
int find_noise(const Raster& level0)
{
    const Size size = level0.size();
    const int rows =
        matcher::kNoiseBlock * std::clamp((1 << 17) / std::max(size.cols, 1), 1, 32);
    matcher::NoiseCounts all;
    std::mutex adding;
    tbb::parallel_for(
        tbb::blocked_range<int>(0, tiling::ceil_div(size.rows, rows), 1),
        [&](const tbb::blocked_range<int>& strips) {
            matcher::NoiseCounts part;
            for (int i = strips.begin(); i < strips.end(); ++i) {
                check_stop();
                const Patch<std::uint16_t> strip =
                    read_part(level0, intersect({i * rows, 0, rows, size.cols}, rect_of(size)));
                part.add(strip.pixels.view());
            }
            const std::lock_guard lock(adding);
            all.add(part);
        });
    return all.noise();
}

matcher::Tone fill(PixelSource& source, const PixelMapping& mapping,
                   std::vector<Raster>& levels, std::string& checksum)
{
    PixelChecksum sum;
    const auto histogram = copy_full_resolution(source, mapping, levels.front(), sum);
    checksum = sum.hex();
    if (std::all_of(histogram->begin(), histogram->end(), [](auto n) { return n == 0; })) {
        throw io::InputError(source.description() +
                             " has no valid pixel: everything is nodata or masked; check the "
                             "nodata value and the mask");
    }
    for (std::size_t k = 1; k < levels.size(); ++k) {
        reduce_level(levels[k - 1], levels[k]);
    }
    matcher::Tone tone = find_tone(source.pixel_type(), *histogram);
    tone.noise = find_noise(levels.front());
    return tone;
}

} // namespace

PreparedPair::PreparedPair(PixelSource& left, PixelSource& right, int levels,
                           const std::filesystem::path& scratch_folder,
                           PairChecksums& checksums)
{
    const auto life = io::ScratchLife::kept;
    left_.levels =
        open_levels(scratch_folder, "left", tiling::pyramid_sizes(left.size(), levels), life);
    right_.levels =
        open_levels(scratch_folder, "right", tiling::pyramid_sizes(right.size(), levels), life);
    const PixelMapping mapping = find_mapping(left, right);
    tbb::parallel_invoke(
        [&] { left_.tone = fill(left, mapping, left_.levels, checksums.left); },
        [&] { right_.tone = fill(right, mapping, right_.levels, checksums.right); });
    matcher::agree_on_noise(left_.tone, right_.tone);
}

PreparedPair::PreparedPair(const matcher::PairShape& shape, int levels, const PairTones& tones,
                           const std::filesystem::path& scratch_folder)
{
    const auto life = io::ScratchLife::existing;
    left_ = {
        open_levels(scratch_folder, "left", tiling::pyramid_sizes(shape.left, levels), life),
        tones.left};
    right_ = {
        open_levels(scratch_folder, "right", tiling::pyramid_sizes(shape.right, levels), life),
        tones.right};
}

void PreparedPair::sync()
{
    for (Pyramid* pyramid : {&left_, &right_}) {
        for (Raster& level : pyramid->levels) {
            level.sync();
        }
    }
}

matcher::LevelImages PreparedPair::read(int level, const tiling::LevelSupport& support) const
{
    const auto k = static_cast<std::size_t>(level);
    return {read_part(left_.levels[k], support.left_image),
            read_part(right_.levels[k], support.right_image)};
}

matcher::LevelImages PreparedPair::read_whole(int level) const
{
    const auto k = static_cast<std::size_t>(level);
    return {read_part(left_.levels[k], rect_of(left_.levels[k].size())),
            read_part(right_.levels[k], rect_of(right_.levels[k].size()))};
}

std::int64_t PreparedPair::disk_bytes(const matcher::PairShape& shape, int levels)
{
    std::int64_t pixels = 0;
    for (const Size full : {shape.left, shape.right}) {
        for (const Size size : tiling::pyramid_sizes(full, levels)) {
            pixels += size.area();
        }
    }
    return pixels * static_cast<std::int64_t>(sizeof(std::uint16_t));
}

} // namespace hsgm::pipeline
