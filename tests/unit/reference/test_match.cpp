#include "tests/catch.h"

#include "matcher/reasons.h"
#include "tests/reference/refine.h"
#include "tests/unit/reference/images.h"

#include <cmath>

using namespace hsgm::reference;
namespace matcher = hsgm::matcher;

namespace {

std::vector<std::uint32_t> list(std::initializer_list<std::uint32_t> values)
{
    return values;
}

PixelCosts sums_of(std::vector<std::uint32_t> values)
{
    PixelCosts sums({0, static_cast<int>(values.size()) - 1});
    sums.values = std::move(values);
    return sums;
}

} // namespace

TEST_CASE("the twin's sub-pixel offset follows its formula")
{
    CHECK(sub_pixel_q8(sums_of({10, 0, 10}), 1) == 256);
    CHECK(sub_pixel_q8(sums_of({10, 0, 15}), 1) == 256 - 58); // x = 170, 72420 >> 10 = 70
    CHECK(sub_pixel_q8(sums_of({15, 0, 10}), 1) == 256 + 58);
    CHECK(sub_pixel_q8(sums_of({15, 0, 0}), 1) == 256 + 128);
    CHECK(sub_pixel_q8(sums_of({1, 0, 300}), 1) == 256 - 127); // x = 0, kept from 128
    CHECK(sub_pixel_q8(sums_of({0, 0, 0}), 1) == 256);
    CHECK(sub_pixel_q8(sums_of({0, 10, 15}), 0) == 0); // no neighbour below
    CHECK(sub_pixel_q8(sums_of({15, 10, 0}), 2) == 512);
}

TEST_CASE("the twin's confidence compares with the best cost two or more away")
{
    CHECK(confidence_of(sums_of({3, 0, 4}), 1) == 255); // nothing to compare with
    CHECK(confidence_of(sums_of({4, 5, 6}), 0) == 85);  // 255 * 2 / 6
    CHECK(confidence_of(sums_of({4, 4, 4}), 0) == 1);
    CHECK(confidence_of(sums_of({0, 9, 0}), 0) == 1);
    CHECK(confidence_of(sums_of({0, 9, 1}), 0) == 255);
}

/// Left tones 1 2 3 4 and right tones 11..16 with disparities -2..0, costs by table:
/// 3 0 4 | 1 6 0 | 0 0 9 | 7 7 7. Every tone step is 1, so P2' = 2 + 9*5/6 = 9.
struct Line {
    HmiCosts table = HmiCosts({256, 256}, 0);
    Image<std::uint16_t> left = pixels({{1, 2, 3, 4}});
    Image<std::uint16_t> right = pixels({{11, 12, 13, 14, 15, 16}});
    DisparityRange asked{-2, 0};
    Options options;

    Line()
    {
        const int costs[4][3] = {{3, 0, 4}, {1, 6, 0}, {0, 0, 9}, {7, 7, 7}};
        for (int x = 0; x < 4; ++x) {
            for (int d = -2; d <= 0; ++d) {
                table(x + 1, 11 + x - d) = static_cast<std::uint8_t>(costs[x][d + 2]);
            }
        }
        options.mode = Mode::sgm;
        options.cost = Cost::hmi;
        options.paths = 4;
        options.p1 = 2;
        options.p2 = 11;
        options.median = 1;
        options.speckle_px = 0;
        options.min_confidence = 0;
        options.smooth = 1;
        options.subpixel = Subpixel::sums;
    }
    MatchResult solve() const { return match(left, right, asked, {}, {}, options, &table); }
};

TEST_CASE("the twin solves a line of four pixels as worked out by hand")
{
    const Line line;
    const MatchResult result = line.solve();
    REQUIRE(result.levels.size() == 1);
    const Level& level = result.levels[0];
    const auto& rightward = level.paths[0];
    CHECK(rightward(0, 0).values == list({3, 0, 4}));
    CHECK(rightward(0, 1).values == list({3, 6, 2}));
    CHECK(rightward(0, 2).values == list({1, 2, 9}));
    CHECK(rightward(0, 3).values == list({7, 8, 10}));
    const auto& leftward = level.paths[1];
    CHECK(leftward(0, 3).values == list({7, 7, 7}));
    CHECK(leftward(0, 2).values == list({0, 0, 9}));
    CHECK(leftward(0, 1).values == list({1, 6, 2}));
    CHECK(leftward(0, 0).values == list({3, 2, 5}));
    CHECK(level.sums(0, 0).values == list({12, 2, 17}));
    CHECK(level.sums(0, 1).values == list({6, 24, 4}));
    CHECK(level.sums(0, 2).values == list({1, 2, 36}));
    CHECK(level.sums(0, 3).values == list({28, 29, 31}));
    CHECK(level.winners == image_of<int>({{-1, 0, -2, -2}}));

    CHECK(result.disparity_q8 == image_of<std::int32_t>({{-256 - 58, 0, -512, -512}}));
    CHECK(result.confidence == image_of<std::uint8_t>({{255, 85, 247, 24}}));
    const std::uint16_t flat = matcher::kLowTexture;
    const std::uint16_t flat_end = matcher::kLowTexture | matcher::kRangeEnd;
    CHECK(result.reasons == pixels({{flat, flat_end, flat_end, flat_end}}));
    CHECK(result.right_keys == image_of<std::uint32_t>({{17u << 16 | 2, 2u << 16 | 1, 12u << 16,
                                                         2u << 16 | 1, 1u << 16, 28u << 16}}));
}

TEST_CASE("the twin's left-right check rejects what the right view contradicts")
{
    Line line;
    const MatchResult first = line.solve();
    // Pixel 1 chose 0; right pixel 1 chose -1, right pixels 2 and 3 chose -2 and -1.
    line.options.left_right_px = 0;
    const RefineResult strict = refine(first, line.asked, line.options);
    CHECK(strict.reasons(0, 1) == (first.reasons(0, 1) | matcher::kOccluded));
    CHECK(strict.disparity_px(0, 1) == -32768.0F);
    CHECK(strict.confidence(0, 1) == 0);
    CHECK(strict.disparity_px(0, 0) == -314 / 256.0F);
    CHECK(strict.confidence(0, 0) > 0);
    CHECK(strict.disparity_px(0, 2) == -2.0F);
    line.options.left_right_px = 1;
    CHECK(refine(first, line.asked, line.options).reasons == first.reasons);
    line.options.left_right_px = -1;
    CHECK(refine(first, line.asked, line.options).reasons == first.reasons);
}

TEST_CASE("the twin's right view takes nothing from nodata pixels")
{
    Line line;
    line.left(0, 0) = kNodata;
    const MatchResult result = line.solve();
    CHECK(result.right_keys(0, 0) == kNoKey);
    CHECK(result.right_keys(0, 1) != kNoKey);
    CHECK(result.reasons(0, 0) == matcher::kNodataLeft);
    CHECK(result.levels[0].matching(0, 0).values == list({24, 24, 24}));
}

TEST_CASE("the twin names why a pixel has no counterpart")
{
    Options options;
    options.mode = Mode::sgm;
    options.speckle_px = 0;
    options.min_confidence = 0;
    const auto left = pixels({{10, 200, 30, 90}});
    const auto right = pixels({{10, kNodata, 30}});
    const MatchResult result = match(left, right, {2, 2}, {}, {}, options);
    CHECK(result.reasons ==
          pixels({{matcher::kOutside, matcher::kOutside, 0, matcher::kNodataRight}}));
    const RefineResult refined = refine(result, {2, 2}, options);
    CHECK(refined.reasons == result.reasons);
    CHECK(refined.disparity_px(0, 2) == 2.0F);
    CHECK(refined.disparity_px(0, 3) == -32768.0F);
}

TEST_CASE("the twin finds a shift through several levels")
{
    Image<std::uint16_t> left({40, 70});
    std::uint32_t state = 1;
    for (int row = 0; row < left.rows(); ++row) {
        for (int col = 0; col < left.cols(); ++col) {
            state = state * 1664525u + 1013904223u;
            left(row, col) = static_cast<std::uint16_t>(state >> 24);
        }
    }
    Image<std::uint16_t> right(left.size());
    for (int row = 0; row < left.rows(); ++row) {
        for (int col = 0; col < left.cols(); ++col) {
            right(row, col) = clamped(left, row, col + 9);
        }
    }
    Options options;
    options.levels = 3;
    options.window_px = 16;
    const MatchResult result = match(left, right, {-32, 63}, {}, {}, options);
    const RefineResult refined = refine(result, {-32, 63}, options);
    CHECK(result.levels[0].sums(16, 32).range.count() < 96);
    for (int row = 4; row < 36; ++row) {
        for (int col = 16; col < 66; ++col) {
            CHECK(result.levels[0].winners(row, col) == 9);
            CHECK(std::abs(refined.disparity_px(row, col) - 9.0F) < 0.5F);
        }
    }
}
