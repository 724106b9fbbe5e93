#include "tests/catch.h"

#include "tiling/image.h"
#include "tiling/shard.h"

#include <stdexcept>
#include <vector>

using namespace hsgm::tiling;

TEST_CASE("the bands of all shards are the raster, each row once")
{
    for (const int rows : {1, 63, 64, 65, 200, 1000, 30'000}) {
        for (const int count : {1, 2, 3, 7, 100}) {
            int next = 0;
            for (int i = 0; i < count; ++i) {
                const Rect band = band_of({rows, 17}, {i, count});
                CHECK(band.row == next);
                CHECK(band.col == 0);
                CHECK(band.cols == 17);
                next = band.row_end();
            }
            CHECK(next == rows);
        }
    }
}

TEST_CASE("bands are cut at multiples of 64 rows and nearly equal")
{
    CHECK(band_of({1000, 10}, {0, 3}) == Rect{0, 0, 320, 10});
    CHECK(band_of({1000, 10}, {1, 3}) == Rect{320, 0, 320, 10});
    CHECK(band_of({1000, 10}, {2, 3}) == Rect{640, 0, 360, 10});
    CHECK(band_of({100, 10}, {0, 7}).empty());
}

TEST_CASE("a shard that is none is refused")
{
    CHECK_THROWS_AS(band_of({100, 10}, {3, 3}), std::invalid_argument);
    CHECK_THROWS_AS(band_of({100, 10}, {-1, 3}), std::invalid_argument);
    CHECK_THROWS_AS(band_of({100, 10}, {0, 0}), std::invalid_argument);
}

TEST_CASE("the rest of a rectangle is what others leave of it")
{
    const Rect wanted{10, 10, 20, 20};
    const auto rest = [&](const std::vector<Rect>& taken) {
        return bounds_of_rest(wanted, taken);
    };
    CHECK(rest({}) == wanted);
    CHECK(rest({{0, 0, 10, 100}}) == wanted);
    CHECK(rest({wanted}).empty());
    CHECK(rest({{0, 0, 100, 100}}).empty());
    CHECK(rest({{10, 10, 20, 10}}) == Rect{10, 20, 20, 10});
    CHECK(rest({{10, 10, 20, 10}, {10, 15, 20, 15}}).empty());
    CHECK(rest({{10, 10, 10, 10}, {20, 20, 10, 10}}) == wanted);
    CHECK(rest({{0, 0, 20, 100}, {20, 0, 10, 25}}) == Rect{20, 25, 10, 5});
    CHECK(rest({{15, 15, 5, 5}}) == wanted); // a hole in the middle
}

TEST_CASE("the rest agrees with a count of pixels for many random rectangles")
{
    std::uint32_t state = 7;
    const auto random = [&](int below) {
        state = state * 1664525U + 1013904223U;
        return static_cast<int>((state >> 16) % static_cast<unsigned>(below));
    };
    const Rect wanted{3, 4, 12, 15};
    for (int round = 0; round < 300; ++round) {
        Patch<std::uint8_t> taken_pixels(wanted);
        std::vector<Rect> taken;
        for (int i = random(9); i >= 0; --i) {
            taken.push_back({random(16), random(20), 1 + random(14), 1 + random(14)});
            const Rect part = intersect(taken.back(), wanted);
            for (int row = part.row; row < part.row_end(); ++row) {
                for (int col = part.col; col < part.col_end(); ++col) {
                    taken_pixels.at(row, col) = 1;
                }
            }
        }
        Rect expected{};
        for (int row = wanted.row; row < wanted.row_end(); ++row) {
            for (int col = wanted.col; col < wanted.col_end(); ++col) {
                if (taken_pixels.at(row, col) == 0) {
                    expected = unite(expected, {row, col, 1, 1});
                }
            }
        }
        const Rect found = bounds_of_rest(wanted, taken);
        CHECK(found.empty() == expected.empty());
        CHECK((found.empty() || found == expected));
    }
}
