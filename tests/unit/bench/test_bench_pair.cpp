#include "tests/catch.h"

#include "io/error.h"
#include "matcher/refine.h"
#include "pipeline/bench/bench_pair.h"
#include "pipeline/synth/renderer.h"

#include <algorithm>
#include <limits>
#include <set>

using namespace hsgm;
using namespace hsgm::bench;

TEST_CASE("the scenes of a benchmark fill at least 60 percent of the range and do not leave it")
{
    const auto [scene, side, disparities] =
        GENERATE(table<std::string, int, int>({{"town", 256, 64},
                                               {"town", 768, 128},
                                               {"town", 1024, 256},
                                               {"towers", 768, 128},
                                               {"towers", 1024, 256}}));
    CAPTURE(scene, side, disparities);
    const BenchPair pair = render_pair(scene, side, disparities);
    CHECK(pair.asked == tiling::DisparityRange{0, disparities - 1});
    const ContentSpan span = content_span(pair.truth_px, pair.asked);
    CHECK(span.percent >= 60);
    CHECK(span.low_px > 0);
    CHECK(span.high_px < disparities - 1);
}

TEST_CASE("a range of a quarter of the side is still a scene that can be rendered")
{
    const std::string scene = GENERATE("town", "towers");
    for (const int side : {64, 256, 2048, 8192, 65536}) {
        CAPTURE(scene, side);
        CHECK_NOTHROW(bench_scene(scene, side, std::min(side / 4, 16000)).validate());
    }
    CHECK_THROWS_AS(bench_scene("sea", 256, 64), std::invalid_argument);
}

TEST_CASE("a rendered pair is what the renderer gives, whatever the number of threads")
{
    const BenchPair pair = render_pair("town", 200, 48);
    const synth::Renderer renderer(bench_scene("town", 200, 48));
    tiling::Image<std::uint16_t> left(pair.left.size());
    renderer.render_left(rect_of(left.size()), left);
    CHECK((pair.left == left));
    tiling::Image<float> truth(left.size());
    renderer.truth_left(rect_of(left.size()), truth);
    CHECK((pair.truth_px == truth));
    const auto pixels = pair.right.pixels();
    CHECK(std::set<std::uint16_t>(pixels.begin(), pixels.end()).size() > 50);
}

TEST_CASE("the span leaves out a thousandth at either end, and what has no value")
{
    tiling::Image<float> map({10, 1000}, 20.0F);
    std::fill_n(map.row(3), 50, 10.0F);
    std::fill_n(map.row(4), 50, 30.0F);
    std::fill_n(map.row(5), 5, 0.0F);
    std::fill_n(map.row(6), 5, 500.0F);
    map(0, 0) = std::numeric_limits<float>::quiet_NaN();
    map(0, 1) = matcher::kNodataDisparity;
    const ContentSpan span = content_span(map, {0, 63});
    CHECK(span.low_px == 10);
    CHECK(span.high_px == 30);
    CHECK(span.percent == Approx(100 * 20.0 / 64));
    CHECK(content_span(tiling::Image<float>({4, 4}, matcher::kNodataDisparity), {0, 63})
              .percent == 0);
}
