#include "tests/catch.h"

#include "tests/reference/hmi.h"
#include "tests/unit/reference/images.h"

#include <algorithm>
#include <cmath>

using namespace hsgm::reference;

TEST_CASE("the twin's Gaussian keeps constants and spreads an impulse over seven")
{
    const std::vector<double> flat = smoothed(std::vector<double>(10, 3.0));
    for (const double value : flat) {
        CHECK(value == Approx(3.0));
    }
    std::vector<double> impulse(11, 0.0);
    impulse[5] = 1.0;
    const std::vector<double> spread = smoothed(impulse);
    const double sum = 1 + 2 * (std::exp(-0.5) + std::exp(-2.0) + std::exp(-4.5));
    CHECK(spread[1] == 0.0);
    CHECK(spread[2] == Approx(std::exp(-4.5) / sum));
    CHECK(spread[4] == Approx(std::exp(-0.5) / sum));
    CHECK(spread[5] == Approx(1 / sum));
    CHECK(spread[8] == Approx(std::exp(-4.5) / sum));
    CHECK(spread[9] == 0.0);
}

TEST_CASE("the twin's table is 24 everywhere when nothing was counted")
{
    CHECK(hmi_table(JointCounts({256, 256}, 0)) == HmiCosts({256, 256}, 24));
}

TEST_CASE("the twin's table is cheap where tones met, and spans 0..48")
{
    JointCounts joint({256, 256}, 0);
    for (int i = 0; i < 256; ++i) {
        joint(i, 255 - i) = 100;
    }
    const HmiCosts table = hmi_table(joint);
    const auto [least, largest] =
        std::minmax_element(table.pixels().begin(), table.pixels().end());
    CHECK(*least == 0);
    CHECK(*largest == 48);
    for (int i = 10; i < 246; i += 9) {
        CHECK(table(i, 255 - i) < 6);
        CHECK(table(i, (255 - i + 128) % 256) > 40);
    }
}

TEST_CASE("the twin counts valid pixels with a valid counterpart inside the right image")
{
    const auto pair =
        make_level_pair(pixels({{1, 2, kNodata, 4}}), pixels({{11, kNodata, 13, 14}}), {}, {},
                        Cost::census5x5, nullptr);
    const JointCounts joint = joint_counts(pair, image_of<int>({{1, 0, 0, 3}}));
    CHECK(joint(4, 11) == 1); // others: outside, nodata right, nodata left
    std::uint64_t total = 0;
    for (const std::uint64_t count : joint.pixels()) {
        total += count;
    }
    CHECK(total == 1);
}

TEST_CASE("the twin learns how the right image renders the tones of the left")
{
    Image<std::uint16_t> left({30, 60});
    std::uint32_t state = 7;
    for (int row = 0; row < left.rows(); ++row) {
        for (int col = 0; col < left.cols(); ++col) {
            state = state * 1664525u + 1013904223u;
            left(row, col) = static_cast<std::uint16_t>(state >> 24);
        }
    }
    Image<std::uint16_t> right(left.size());
    for (int row = 0; row < left.rows(); ++row) {
        for (int col = 0; col < left.cols(); ++col) {
            right(row, col) = static_cast<std::uint16_t>(clamped(left, row, col + 5) / 2 + 60);
        }
    }
    Options options;
    options.cost = Cost::hmi;
    const HmiCosts table = solve_hmi(left, right, {0, 15}, {}, {}, options);
    int cheaper = 0;
    for (int tone = 20; tone < 230; ++tone) {
        cheaper += table(tone, tone / 2 + 60) < table(tone, 60 + (tone / 2 + 60) % 127);
    }
    CHECK(cheaper > 200);
}
