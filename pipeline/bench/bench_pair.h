#pragma once

#include "matcher/level_plan.h"
#include "matcher/pixel.h"
#include "pipeline/synth/scene.h"
#include "tiling/image.h"

#include <cstdint>
#include <string>

namespace hsgm::bench {

/// A pair in memory, as matcher and peers take it, and what is known about it.
struct BenchPair {
    std::string source; ///< for reports: the scene's name, or the two files
    tiling::Image<std::uint16_t> left;
    tiling::Image<std::uint16_t> right;
    matcher::Tone left_tone;
    matcher::Tone right_tone;
    tiling::DisparityRange asked;
    tiling::Image<float> truth_px;       ///< empty for given images; likewise below
    tiling::Image<std::uint8_t> visible; ///< 255: shows in both images

    matcher::PairShape shape() const { return {left.size(), right.size(), asked}; }
    bool has_truth() const { return truth_px.size().area() > 0; }
};

/// The scenes that a benchmark can render. They differ in how far the disparities of
/// one window lie apart, which is what range pruning lives on.
///
/// `town`:   a town on hills, as satellites see it: the ground rises and falls by half of the
///           range across the image, roofs stand up to a quarter of it (at most 40 px) above.
/// `towers`: roofs of up to 85 % of the range, on flat ground.
///
/// Disparities 0..disparities-1. `disparities` of more than a quarter of the side make hills
/// too steep for any pair; `validate` refuses them.
synth::Scene bench_scene(const std::string& name, int side_px, int disparities);

/// Renders a scene of `bench_scene` on all threads of the caller's arena.
BenchPair render_pair(const std::string& name, int side_px, int disparities);

/// Reads two images whole. Throws InputError for images that are no rectified pair, and
/// ConfigError for a range in which they have nothing in common.
BenchPair read_pair(const std::string& left, const std::string& right,
                    tiling::DisparityRange asked);

/// How much of the asked range a disparity map fills.
struct ContentSpan {
    double low_px = 0;  ///< the 0.1 percentile of the values
    double high_px = 0; ///< the 99.9 percentile
    double percent = 0; ///< of the range between them: 100 (high - low) / count
};

/// The span of the values of a map; NaN and kNodataDisparity do not count, values outside
/// the range count as its ends. All zero where there is no value.
ContentSpan content_span(tiling::ImageView<const float> disparity_px,
                         tiling::DisparityRange asked);

} // namespace hsgm::bench
