#include "pipeline/stages/quick_match.h"

#include "matcher/matcher.h"
#include "matcher/noise.h"
#include "matcher/reduce.h"
#include "matcher/refine.h"
#include "pipeline/stages/pixel_mapping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace hsgm::pipeline {

namespace {

using tiling::Image;
using tiling::Patch;

Patch<std::uint16_t> whole(Image<std::uint16_t> image)
{
    Patch<std::uint16_t> patch;
    patch.rect = rect_of(image.size());
    patch.pixels = std::move(image);
    return patch;
}

struct Pyramid {
    std::vector<Patch<std::uint16_t>> levels;
    matcher::Tone tone;
};

// The pixels, mapped to 16 bits for this image alone, since the costs ask for order and not
// for values.
Pyramid pyramid(const Image<double>& values, int levels)
{
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const double value : values.pixels()) {
        if (!std::isnan(value)) {
            least = std::min(least, value);
            most = std::max(most, value);
        }
    }
    constexpr double kHighestPixel = 65534;
    const PixelMapping mapping{least, most > least ? kHighestPixel / (most - least) : 1};
    Image<std::uint16_t> pixels(values.size());
    std::transform(values.pixels().begin(), values.pixels().end(), pixels.data(), mapping);
    auto histogram = std::make_unique<PixelHistogram>();
    for (const std::uint16_t pixel : pixels.pixels()) {
        ++(*histogram)[pixel];
    }
    (*histogram)[matcher::kNodataPixel] = 0;
    Pyramid result;
    result.tone = find_tone(io::PixelType::uint16, *histogram);
    result.tone.noise = matcher::noise_of(pixels.view());
    result.levels.push_back(whole(std::move(pixels)));
    while (static_cast<int>(result.levels.size()) < levels) {
        const auto& fine = result.levels.back();
        Image<std::uint16_t> coarse(halve(fine.pixels.size()));
        matcher::reduce(fine, fine.pixels.size(), rect_of(coarse.size()), coarse);
        result.levels.push_back(whole(std::move(coarse)));
    }
    return result;
}

template <typename T>
Patch<T> patch_of(const tiling::Rect& rect, Image<T> pixels)
{
    Patch<T> patch;
    patch.rect = rect;
    patch.pixels = std::move(pixels);
    return patch;
}

// The right view's keys for the columns that the second pass wants.
Patch<std::uint32_t> keys(const Patch<std::uint32_t>& made, const tiling::Rect& wanted)
{
    Patch<std::uint32_t> patch(wanted, std::numeric_limits<std::uint32_t>::max());
    const tiling::Rect both = intersect(made.rect, wanted);
    for (int row = both.row; row < both.row_end(); ++row) {
        for (int col = both.col; col < both.col_end(); ++col) {
            patch.at(row, col) = made.at(row, col);
        }
    }
    return patch;
}

} // namespace

Image<float> quick_match(const Image<double>& left, const Image<double>& right,
                         tiling::DisparityRange disparity, int least_confidence)
{
    matcher::Options options;
    matcher::PairTraits traits;
    traits.shape = {left.size(), right.size(), disparity};
    const int levels = matcher::plan_levels(traits.shape, options).levels();
    const Pyramid a = pyramid(left, levels);
    const Pyramid b = pyramid(right, levels);
    traits.left_tone = a.tone;
    traits.right_tone = b.tone;
    matcher::agree_on_noise(traits.left_tone, traits.right_tone);
    const matcher::Matcher matcher(traits, options);
    const auto coarse = matcher.solve_coarse(a.levels.back().pixels, b.levels.back().pixels);
    std::vector<matcher::LevelImages> images;
    for (int level = 0; level < matcher.plan().windowed_levels(); ++level) {
        const auto k = static_cast<std::size_t>(level);
        images.push_back({a.levels[k], b.levels[k]});
    }
    const tiling::Rect all = rect_of(left.size());
    matcher::TileMatch match = matcher.match_tile(all, images, *coarse);
    const matcher::RefineSupport support = matcher::refine_support(all, traits.shape, options);
    const matcher::RefineInput input{patch_of(all, std::move(match.disparity_q8)),
                                     patch_of(all, std::move(match.confidence)),
                                     patch_of(all, std::move(match.reasons)),
                                     keys(match.right_keys, support.right_keys),
                                     a.levels.front(),
                                     b.levels.front()};
    matcher::Refined refined = matcher::refine(all, input, traits.shape, options);
    for (std::int64_t i = 0; i < left.size().area(); ++i) {
        if (refined.confidence.data()[i] < least_confidence) { // 0 where there is no value
            refined.disparity_px.data()[i] = std::numeric_limits<float>::quiet_NaN();
        }
    }
    return std::move(refined.disparity_px);
}

} // namespace hsgm::pipeline
