#include "tests/catch.h"

#include "tests/reference/pyramid.h"
#include "tests/unit/reference/images.h"

using namespace hsgm::reference;

TEST_CASE("the twin reduces by weights 1-3-3-1, replicated at the borders")
{
    CHECK(reduced(pixels({{7}})) == pixels({{7}}));
    // Columns -1..2 are 10 10 20 20.
    CHECK(reduced(pixels({{10, 20}})) == pixels({{15}}));
    CHECK(reduced(pixels({{10}, {20}})) == pixels({{15}}));
    // (1*0 + 3*0 + 3*8 + 1*100) / 8 = 15.5; (1*8 + 3*100 + 3*4 + 1*4) / 8 = 40.5.
    CHECK(reduced(pixels({{0, 8, 100, 4}})) == pixels({{16, 41}}));
    // Rows (1 1 3 5 ..) as 1-3-3-1 and columns alike, on r + c.
    CHECK(reduced(pixels({{0, 1, 2, 3}, {1, 2, 3, 4}, {2, 3, 4, 5}, {3, 4, 5, 6}})) ==
          pixels({{1, 3}, {3, 5}}));
}

TEST_CASE("the twin leaves nodata out of the mean, and keeps it where nothing is left")
{
    // (1*8 + 3*100) / 4 = 77 at column 1.
    CHECK(reduced(pixels({{0, 8, 100, kNodata}})) == pixels({{16, 77}}));
    CHECK(reduced(pixels({{kNodata, kNodata}, {kNodata, kNodata}})) == pixels({{kNodata}}));
    // Only the corner tap of weight 1 is valid.
    const auto n = kNodata;
    CHECK(reduced(pixels({{n, n, n, n}, {n, n, n, n}, {n, n, 9, n}, {n, n, n, n}})) ==
          pixels({{9, 9}, {9, 9}}));
    CHECK(reduced(pixels({{65534, 65534}})) == pixels({{65534}}));
}

TEST_CASE("the twin halves sizes upwards")
{
    const auto levels = pyramid(Image<std::uint16_t>({5, 9}, 3), 4);
    REQUIRE(levels.size() == 4);
    CHECK(levels[1].size() == Size{3, 5});
    CHECK(levels[2].size() == Size{2, 3});
    CHECK(levels[3].size() == Size{1, 2});
    CHECK(levels[3](0, 1) == 3);
}

TEST_CASE("the twin's tone ends leave out a thousandth on either side")
{
    Image<std::uint16_t> ramp({1, 1001}, kNodata);
    for (int c = 0; c < 1000; ++c) {
        ramp(0, c) = static_cast<std::uint16_t>(c);
    }
    // 1000 valid pixels: count(<= v) > 1 at v = 1, count(<= v) >= 999 at v = 998.
    const ToneEnds ends = tone_ends(ramp);
    CHECK(ends == ToneEnds{1, 998});
    const auto tones = toned(ramp, ends);
    CHECK(tones(0, 0) == 0);
    CHECK(tones(0, 1) == 0);
    CHECK(tones(0, 500) == 127); // 499 * 255 / 997 = 127.6
    CHECK(tones(0, 998) == 255);
    CHECK(tones(0, 999) == 255);
    CHECK(tones(0, 1000) == 0); // nodata

    CHECK(tone_ends(pixels({{5, 5, 5}})) == ToneEnds{5, 6});
    CHECK(tone_ends(pixels({{65534, 65534}})) == ToneEnds{65534, 65535});
    CHECK(toned(pixels({{0, 37, 255, kNodata}}), {}) ==
          image_of<std::uint8_t>({{0, 37, 255, 0}}));
}

TEST_CASE("the twin widens ranges so that every level halves without remainder")
{
    CHECK(level_range({-5, 10}, 0, 3) == DisparityRange{-5, 10});
    CHECK(level_range({-5, 10}, 1, 3) == DisparityRange{-4, 5}); // from -8..11
    CHECK(level_range({-5, 10}, 2, 3) == DisparityRange{-2, 2});
    CHECK(level_range({-5, 10}, 0, 1) == DisparityRange{-5, 10});
    CHECK(level_range({4, 4}, 1, 2) == DisparityRange{2, 2}); // from 4..5
}

TEST_CASE("the twin counts levels by cells and least sides")
{
    Options hsgm;
    Options paper;
    paper.mode = Mode::hsgm_paper;
    const DisparityRange asked{0, 511};
    const auto count = [&](int side, const Options& options) {
        return level_count({side, side}, {side, side}, asked, options);
    };
    CHECK(count(40000, hsgm) == 6); // 1250^2 * 16 = 25 M cells
    CHECK(count(40000, paper) == 3);
    CHECK(count(128, hsgm) == 3);
    CHECK(count(125, hsgm) == 3); // 125 63 32
    CHECK(count(124, hsgm) == 2); // 124 62 31
    CHECK(count(63, hsgm) == 2);
    CHECK(count(62, hsgm) == 1);
    CHECK(count(1, hsgm) == 1);
    CHECK(level_count({4096, 4096}, {4096, 124}, asked, hsgm) == 2);

    hsgm.levels = 5;
    CHECK(count(1, hsgm) == 5);
    hsgm.mode = Mode::sgm;
    CHECK(count(4000, hsgm) == 1);
    hsgm.mode = Mode::local;
    CHECK(count(4000, hsgm) == 1);
}
