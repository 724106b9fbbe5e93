#include "tests/catch.h"

#include "tests/reference/cost.h"
#include "tests/unit/reference/images.h"

#include <string>

using namespace hsgm::reference;

namespace {

/// The bits of one row of the neighbourhood, repeated for every row.
CensusBits rows_of(const std::string& row, int rows)
{
    CensusBits bits;
    std::size_t bit = 0;
    for (int r = 0; r < rows; ++r) {
        for (const char c : row) {
            bits[bit++] = c == '1';
        }
    }
    return bits;
}

} // namespace

TEST_CASE("the twin's census bits say which neighbours are below, nodata never is")
{
    const auto image = pixels({{5, 9, kNodata}});
    CHECK(census_at(image, 0, 1, 5, 5) == rows_of("11000", 5));
    CHECK(census_at(image, 0, 1, 7, 7) == rows_of("1110000", 7));
    CHECK(census_at(image, 0, 1, 7, 9) == rows_of("111100000", 7));
    CHECK(census_at(image, 0, 0, 5, 5).none());

    // Seen from row 2, the neighbourhood's first row is the only one below the centre.
    const auto column = pixels({{1}, {2}, {2}, {2}});
    CensusBits above;
    for (std::size_t i = 0; i < 5; ++i) {
        above[i] = true;
    }
    CHECK(census_at(column, 2, 0, 5, 5) == above);
}

TEST_CASE("the twin's matching cost is half its maximum where there is no counterpart")
{
    const auto left = pixels({{5, 9, kNodata}});
    const auto right = pixels({{9, 5, 5, kNodata}});
    const auto pair = make_level_pair(left, right, {}, {}, Cost::census5x5, nullptr);
    CHECK(matching_cost(pair, 0, 1, 1) == 40);  // 11000 against 00011, five rows, doubled
    CHECK(matching_cost(pair, 0, 1, -1) == 20); // 11000 against 00000
    CHECK(matching_cost(pair, 0, 1, 2) == 24);  // left of the right image
    CHECK(matching_cost(pair, 0, 1, -2) == 24); // a nodata counterpart
    CHECK(matching_cost(pair, 0, 1, -3) == 24); // right of the right image
    CHECK(matching_cost(pair, 0, 2, 1) == 24);  // a nodata pixel

    const auto wide = make_level_pair(left, right, {}, {}, Cost::census9x7, nullptr);
    CHECK(matching_cost(wide, 0, 1, 1) == 42); // 111100000 against 000001100, seven rows
    CHECK(matching_cost(wide, 0, 1, 2) == 29);
    const auto seven = make_level_pair(left, right, {}, {}, Cost::census7x7, nullptr);
    CHECK(matching_cost(seven, 0, 1, 1) == 35); // 1110000 against 0000110
    CHECK(matching_cost(seven, 0, 1, 2) == 24);
}

TEST_CASE("the twin caps census 9x7 at 59")
{
    Image<std::uint16_t> peak({7, 9}, 1);
    Image<std::uint16_t> hollow({7, 9}, 1);
    peak(3, 4) = 2;
    hollow(3, 4) = 0;
    const auto pair = make_level_pair(peak, hollow, {}, {}, Cost::census9x7, nullptr);
    CHECK(matching_cost(pair, 3, 4, 0) == 59); // 62 bits differ
    CHECK(matching_cost(pair, 3, 3, 0) == 1);  // only the hollow is below
}

TEST_CASE("the twin compares touching pixels, both ways inside the block")
{
    CHECK(pairs_at(Image<std::uint16_t>({5, 5}, 9), 2, 2).none());
    // A bright centre is above the 4 pixels that come after it, and by the bits the other way
    // round above the 2 before it that share a side.
    Image<std::uint16_t> peak({5, 5}, 9);
    peak(2, 2) = 10;
    CHECK(pairs_at(peak, 2, 2).count() == 4 + 2);
    Image<std::uint16_t> corner({5, 5}, 9);
    corner(0, 0) = 8; // touches one pixel of the block
    CHECK(pairs_at(corner, 2, 2).count() == 1);
    corner(0, 0) = 10;
    CHECK(pairs_at(corner, 2, 2).none());
    Image<std::uint16_t> slope({5, 5});
    for (int row = 0; row < 5; ++row) {
        for (int col = 0; col < 5; ++col) {
            slope(row, col) = static_cast<std::uint16_t>(10 * row + col);
        }
    }
    // Rising in reading order: of the 12 the bits that compare upwards, of the 52 those whose
    // pixel in the block comes later: 3 of each of the three rows to the row above, and one
    // to the left of each row's first.
    CHECK(pairs_at(slope, 2, 2).count() == 12 + 9 + 3 + 4);
    slope(2, 2) = kNodata;
    CHECK(pairs_at(slope, 2, 2).count() < 28);
    CHECK(pairs_at(Image<std::uint16_t>({5, 5}, kNodata), 2, 2).none());
}

TEST_CASE("the twin's ternary bits leave a band of noise")
{
    const auto image = pixels({{10, 12, 11, 8, kNodata}});
    const auto bits = [&](int t) { return ternary_at(image, 0, 2, t).count(); };
    CHECK(bits(0) == 5 * 3); // 10 and 8 below, 12 above, in five equal rows; nodata neither
    CHECK(bits(1) == 5);     // 8 alone
    CHECK(bits(3) == 0);
    const auto pair =
        make_level_pair(image, image, {0, 1000}, {0, 255}, Cost::ternary5x5, nullptr);
    CHECK(matching_cost(pair, 0, 2, 0) == 5); // bands of 4 and of 1
}

TEST_CASE("the twin adds the difference of tones to a census, as far as 24")
{
    const auto left = pixels({{100, 107, 200}});
    const auto right = pixels({{100, 100, 100}});
    const auto pair = make_level_pair(left, right, {}, {}, Cost::census_ad, nullptr);
    CHECK(matching_cost(pair, 0, 0, 0) == 0);
    CHECK(matching_cost(pair, 0, 1, 0) == 2 * 10 + 3); // two columns of five are below 107
    CHECK(matching_cost(pair, 0, 2, 0) == 2 * 10 + 12);
    CHECK(matching_cost(pair, 0, 2, 3) == 29);
}

TEST_CASE("the twin's gradients are clipped, and leave out nodata")
{
    const auto image = pixels({{0, 1, 3, 60, kNodata, 60}});
    const Image<std::uint8_t> tone = toned(image, {});
    const auto at = [&](int col) { return gradient_at(image, tone, 0, col); };
    CHECK(at(0) == 15 + 4 * 1);
    CHECK(at(1) == 15 + 4 * 3);
    CHECK(at(2) == 30);
    CHECK(at(3) == 15); // beside nodata
    CHECK(at(4) == 15);
}

TEST_CASE("the twin's sampling differences vanish within half a pixel")
{
    CHECK(sampling_difference({10, 8, 12}, {12, 10, 14}) == 0);
    CHECK(sampling_difference({10, 10, 10}, {13, 12, 14}) == 2);
    CHECK(sampling_difference({14, 14, 16}, {10, 9, 11}) == 3);
    CHECK(sampling_difference({14, 10, 16}, {10, 9, 11}) == 0);
}

TEST_CASE("the twin adds up differences over nine pixels")
{
    Image<std::uint16_t> left({3, 3}, 100);
    Image<std::uint16_t> right({3, 3}, 108);
    const auto pair = make_level_pair(left, right, {}, {}, Cost::birchfield_tomasi, nullptr);
    CHECK(matching_cost(pair, 1, 1, 0) == 9 * (8 / 4) / 4);
    CHECK(matching_cost(pair, 1, 1, 1) == (6 * 2 + 3 * 13) / 4); // a column without counterpart
    CHECK(matching_cost(pair, 1, 0, 1) == 29);
    right(0, 0) = kNodata;
    const auto holed = make_level_pair(left, right, {}, {}, Cost::birchfield_tomasi, nullptr);
    CHECK(matching_cost(holed, 1, 1, 0) == (8 * 2 + 13) / 4);
    CHECK(matching_cost(holed, 0, 1, 0) == (7 * 2 + 2 * 13 - 2 * 2 + 2 * 2) / 4);
}

TEST_CASE("the twin looks up cost hmi by the tones of both pixels")
{
    HmiCosts table({256, 256}, 5);
    table(255, 0) = 7;
    table(0, 255) = 9;
    const auto pair = make_level_pair(pixels({{100, 200}}), pixels({{100, 200}}), {100, 200},
                                      {100, 200}, Cost::hmi, &table);
    CHECK(matching_cost(pair, 0, 0, 0) == 5);
    CHECK(matching_cost(pair, 0, 1, 1) == 7);
    CHECK(matching_cost(pair, 0, 0, -1) == 9);
    CHECK(matching_cost(pair, 0, 0, 1) == 24);
}

TEST_CASE("the twin calls a pixel flat when valid tones within three pixels span under seven")
{
    Image<std::uint16_t> image({1, 12}, 100);
    image(0, 8) = 107;
    image(0, 0) = kNodata;
    const auto pair = make_level_pair(image, image, {}, {}, Cost::census5x5, nullptr);
    CHECK(!is_flat(pair, 0, 0)); // nodata itself
    CHECK(is_flat(pair, 0, 1));  // its neighbour is left out
    CHECK(is_flat(pair, 0, 4));
    CHECK(!is_flat(pair, 0, 5));
    CHECK(!is_flat(pair, 0, 11));
    image(0, 8) = 106;
    const auto flatter = make_level_pair(image, image, {}, {}, Cost::census5x5, nullptr);
    CHECK(is_flat(flatter, 0, 5));
}

TEST_CASE("the twin's prior averages the coarser level's sums at odd disparities")
{
    PixelCosts sums({0, 2});
    sums.values = {100, 4, 25};
    const PixelCosts q = prior_of(sums, 4);
    CHECK(q.values == std::vector<std::uint32_t>{16, 0, 5});
    const std::vector<std::uint32_t> expected{16, 16, 16, 8, 0, 3, 5, 11, 16};
    for (int d = -2; d <= 6; ++d) {
        CHECK(prior_at(q, d) == expected[static_cast<std::size_t>(d + 2)]);
    }
}
