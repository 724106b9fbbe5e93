// Speed of the whole match beside OpenCV's, on one thread and the same synthetic city, in
// pixels x disparities of the asked range per second. Compare rates of one run only.

#include "matcher/matcher.h"
#include "matcher/reduce.h"
#include "matcher/refine.h"
#include "pipeline/synth/renderer.h"
#include "tiling/tile_plan.h"

#include <benchmark/benchmark.h>
#include <opencv2/calib3d.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <vector>

namespace {

using namespace hsgm;

constexpr int kSide = 1024;

struct TestPair {
    tiling::Image<std::uint16_t> left{{kSide, kSide}};
    tiling::Image<std::uint16_t> right{{kSide, kSide}};
};

// A city whose roofs use most of the range 0..disparities-1.
const TestPair& city(int disparities)
{
    static std::vector<std::pair<int, TestPair>> made;
    for (const auto& [count, pair] : made) {
        if (count == disparities) {
            return pair;
        }
    }
    synth::Scene scene;
    scene.size = {kSide, kSide};
    scene.terrain.offset_px = 8;
    scene.city.emplace();
    scene.city->height_max_px = 0.7 * disparities;
    const synth::Renderer renderer(scene);
    auto& pair = made.emplace_back(disparities, TestPair{}).second;
    renderer.render_left(tiling::rect_of(scene.size), pair.left);
    renderer.render_right(tiling::rect_of(scene.size), pair.right);
    return pair;
}

std::vector<matcher::LevelImages> pyramid(const TestPair& pair, const matcher::LevelPlan& plan)
{
    std::vector<matcher::LevelImages> levels(1);
    levels[0].left = {};
    levels[0].left.rect = levels[0].right.rect = tiling::rect_of({kSide, kSide});
    levels[0].left.pixels = pair.left;
    levels[0].right.pixels = pair.right;
    for (std::size_t k = 1; k < plan.left_sizes.size(); ++k) {
        matcher::LevelImages next{
            tiling::Patch<std::uint16_t>(tiling::rect_of(plan.left_sizes[k])),
            tiling::Patch<std::uint16_t>(tiling::rect_of(plan.right_sizes[k]))};
        matcher::reduce(levels.back().left, plan.left_sizes[k - 1], next.left.rect,
                        next.left.pixels);
        matcher::reduce(levels.back().right, plan.right_sizes[k - 1], next.right.rect,
                        next.right.pixels);
        levels.push_back(std::move(next));
    }
    return levels;
}

matcher::Refined match(const TestPair& images, const matcher::Matcher& matcher)
{
    auto levels = pyramid(images, matcher.plan());
    const auto coarse =
        matcher.solve_coarse(levels.back().left.pixels, levels.back().right.pixels);
    levels.resize(static_cast<std::size_t>(matcher.plan().windowed_levels()));
    const tiling::Rect whole = tiling::rect_of({kSide, kSide});
    const auto tile = matcher.match_tile(whole, levels, *coarse);
    matcher::RefineInput input;
    input.disparity_q8.rect = input.confidence.rect = input.reasons.rect = whole;
    input.disparity_q8.pixels = tile.disparity_q8;
    input.confidence.pixels = tile.confidence;
    input.reasons.pixels = tile.reasons;
    input.right_keys = tile.right_keys;
    input.left = levels[0].left;
    input.right = levels[0].right;
    return matcher::refine(whole, input, matcher.pair().shape, matcher.options());
}

void set_rate(benchmark::State& state, int disparities)
{
    const double cells = double{kSide} * kSide * disparities;
    state.counters["px*d/s"] = benchmark::Counter(
        cells * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void hsgm_match(benchmark::State& state, matcher::Mode mode, bool prune)
{
    const int disparities = static_cast<int>(state.range(0));
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    matcher::Options options;
    options.mode = mode;
    options.prune = prune;
    matcher::PairTraits pair;
    pair.shape = {{kSide, kSide}, {kSide, kSide}, {0, disparities - 1}};
    const matcher::Matcher matcher(pair, options);
    const TestPair& images = city(disparities);
    for (auto _ : state) {
        benchmark::DoNotOptimize(match(images, matcher));
    }
    set_rate(state, disparities);
}

cv::Mat bytes(const tiling::Image<std::uint16_t>& image)
{
    cv::Mat result(image.rows(), image.cols(), CV_8U);
    for (int row = 0; row < image.rows(); ++row) {
        std::transform(image.row(row), image.row(row) + image.cols(), result.ptr(row),
                       [](std::uint16_t pixel) { return static_cast<std::uint8_t>(pixel); });
    }
    return result;
}

void opencv_match(benchmark::State& state, int mode)
{
    const int disparities = static_cast<int>(state.range(0));
    cv::setNumThreads(1);
    const TestPair& images = city(disparities);
    const cv::Mat left = bytes(images.left);
    const cv::Mat right = bytes(images.right);
    const auto sgbm =
        cv::StereoSGBM::create(0, disparities, 3, 8 * 9, 32 * 9, 1, 0, 0, 0, 0, mode);
    cv::Mat disparity;
    for (auto _ : state) {
        sgbm->compute(left, right, disparity);
    }
    set_rate(state, disparities);
}

BENCHMARK_CAPTURE(hsgm_match, hsgm, matcher::Mode::hsgm, true)->Arg(128)->Arg(256);
BENCHMARK_CAPTURE(hsgm_match, hsgm_unpruned, matcher::Mode::hsgm, false)->Arg(128);
BENCHMARK_CAPTURE(hsgm_match, sgm, matcher::Mode::sgm, false)->Arg(128);
BENCHMARK_CAPTURE(opencv_match, hh, cv::StereoSGBM::MODE_HH)->Arg(128)->Arg(256);
BENCHMARK_CAPTURE(opencv_match, hh4, cv::StereoSGBM::MODE_HH4)->Arg(128);
BENCHMARK_CAPTURE(opencv_match, three_way, cv::StereoSGBM::MODE_SGBM_3WAY)->Arg(128);

} // namespace

BENCHMARK_MAIN();
