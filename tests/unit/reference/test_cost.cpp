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
