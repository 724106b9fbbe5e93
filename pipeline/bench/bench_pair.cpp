#include "pipeline/bench/bench_pair.h"

#include "io/error.h"
#include "io/raster_source.h"
#include "matcher/noise.h"
#include "matcher/refine.h"
#include "pipeline/error.h"
#include "pipeline/stages/pixel_mapping.h"
#include "pipeline/synth/renderer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace hsgm::bench {

namespace {

using tiling::Image;
using tiling::Rect;

constexpr int kBandRows = 64;

// Calls render(part, view of that part) for bands of rows, side by side.
template <typename T, typename Render>
Image<T> rendered(tiling::Size size, Render render)
{
    Image<T> image(size);
    tbb::parallel_for(0, tiling::ceil_div(size.rows, kBandRows), [&](int band) {
        pipeline::check_stop();
        const Rect part = tiling::intersect({band * kBandRows, 0, kBandRows, size.cols},
                                            tiling::rect_of(size));
        render(part, image.view().part(part));
    });
    return image;
}

// All pixels of a source, and how often each value occurs.
Image<std::uint16_t> read_image(pipeline::PixelSource& source,
                                const pipeline::PixelMapping& mapping,
                                pipeline::PixelHistogram& histogram)
{
    Image<std::uint16_t> image(source.size());
    for (const Rect& window : source.reading_windows()) {
        Image<double> values(window.size());
        source.read(window, values);
        for (int r = 0; r < window.rows; ++r) {
            std::transform(values.row(r), values.row(r) + window.cols,
                           image.row(window.row + r) + window.col, mapping);
        }
    }
    for (const std::uint16_t pixel : image.pixels()) {
        ++histogram[pixel];
    }
    histogram[matcher::kNodataPixel] = 0;
    return image;
}

void find_noise(BenchPair& pair)
{
    pair.left_tone.noise = matcher::noise_of(pair.left.view());
    pair.right_tone.noise = matcher::noise_of(pair.right.view());
    matcher::agree_on_noise(pair.left_tone, pair.right_tone);
}

synth::City city_of(double tallest_px)
{
    synth::City city;
    city.height_max_px = tallest_px;
    return city;
}

} // namespace

synth::Scene bench_scene(const std::string& name, int side_px, int disparities)
{
    const double range = disparities;
    const double side = side_px;
    synth::Scene scene;
    scene.size = {side_px, side_px};
    scene.seed = 7;
    if (name == "town") {
        // Hills and roofs together leave the ends of the range free.
        const double roofs = std::min(0.25 * range, 40.0);
        scene.terrain.offset_px = (range - roofs) / 2;
        scene.terrain.waves = {{0.25 * range, side, 70, 0}, {0.04 * range, side / 2, 35, 40}};
        scene.city = city_of(roofs);
    } else if (name == "towers") {
        scene.terrain.offset_px = 0.04 * range;
        scene.city = city_of(std::min(0.85 * range, 1e4));
    } else {
        throw std::invalid_argument("there is no scene '" + name + "'");
    }
    scene.left.noise_gray = 1.5;
    scene.right = {0.92, 0.04, 1.1, 1.5, 0, {}};
    return scene;
}

BenchPair render_pair(const std::string& name, int side_px, int disparities)
{
    const synth::Renderer renderer(bench_scene(name, side_px, disparities));
    const tiling::Size size = renderer.scene().size;
    BenchPair pair;
    pair.source = "scene " + name;
    pair.asked = {0, disparities - 1};
    pair.left = rendered<std::uint16_t>(
        size, [&](const Rect& part, auto out) { renderer.render_left(part, out); });
    pair.right = rendered<std::uint16_t>(
        size, [&](const Rect& part, auto out) { renderer.render_right(part, out); });
    pair.truth_px = rendered<float>(
        size, [&](const Rect& part, auto out) { renderer.truth_left(part, out); });
    pair.visible = rendered<std::uint8_t>(
        size, [&](const Rect& part, auto out) { renderer.visible_left(part, out); });
    find_noise(pair);
    return pair;
}

BenchPair read_pair(const std::string& left, const std::string& right,
                    tiling::DisparityRange asked)
{
    pipeline::FileSource left_source(io::RasterSource(io::ImageSpec{left}));
    pipeline::FileSource right_source(io::RasterSource(io::ImageSpec{right}));
    const auto mapping = pipeline::find_mapping(left_source, right_source);
    BenchPair pair;
    pair.source = left + ", " + right;
    pair.asked = asked;
    const auto histogram = std::make_unique<pipeline::PixelHistogram>();
    pair.left = read_image(left_source, mapping, *histogram);
    pair.left_tone = pipeline::find_tone(left_source.pixel_type(), *histogram);
    histogram->fill(0);
    pair.right = read_image(right_source, mapping, *histogram);
    pair.right_tone = pipeline::find_tone(right_source.pixel_type(), *histogram);
    find_noise(pair);
    if (pair.left.rows() != pair.right.rows()) {
        throw io::InputError(left + " and " + right +
                             " differ in height; a rectified pair has equal heights");
    }
    try {
        matcher::plan_levels(pair.shape(), {});
    } catch (const std::invalid_argument& refused) {
        throw io::ConfigError(refused.what());
    }
    return pair;
}

ContentSpan content_span(tiling::ImageView<const float> disparity_px,
                         tiling::DisparityRange asked)
{
    std::vector<float> values;
    values.reserve(static_cast<std::size_t>(disparity_px.size().area()));
    for (int row = 0; row < disparity_px.rows(); ++row) {
        for (const float value : disparity_px.row_span(row)) {
            if (!std::isnan(value) && value != matcher::kNodataDisparity) {
                values.push_back(std::clamp(value, static_cast<float>(asked.min),
                                            static_cast<float>(asked.max)));
            }
        }
    }
    if (values.empty()) {
        return {};
    }
    const auto percentile = [&values](double share) {
        const auto at = values.begin() + static_cast<std::ptrdiff_t>(
                                             share * static_cast<double>(values.size() - 1));
        std::nth_element(values.begin(), at, values.end());
        return static_cast<double>(*at);
    };
    const double low = percentile(0.001);
    const double high = percentile(0.999);
    return {low, high, 100 * (high - low) / asked.count()};
}

} // namespace hsgm::bench
