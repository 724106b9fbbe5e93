#include "tests/catch.h"

#include "tiling/pyramid.h"

using namespace hsgm::tiling;

TEST_CASE("every pyramid level has half the size, rounded up")
{
    const auto sizes = pyramid_sizes({101, 64}, 4);
    REQUIRE(sizes.size() == 4);
    CHECK(sizes[0] == Size{101, 64});
    CHECK(sizes[1] == Size{51, 32});
    CHECK(sizes[2] == Size{26, 16});
    CHECK(sizes[3] == Size{13, 8});
    CHECK(pyramid_sizes({1, 1}, 3).back() == Size{1, 1});
}

TEST_CASE("every fine pixel has its coarser pixel in the next level")
{
    for (int n = 1; n < 40; ++n) {
        const auto sizes = pyramid_sizes({n, n + 3}, 5);
        for (std::size_t k = 1; k < sizes.size(); ++k) {
            CHECK((sizes[k - 1].rows - 1) / 2 == sizes[k].rows - 1);
            CHECK((sizes[k - 1].cols - 1) / 2 == sizes[k].cols - 1);
        }
    }
}

TEST_CASE("a coarse pixel is made of four rows and columns round its fine pixels")
{
    CHECK(pyramid_taps({0, 0, 1, 1}) == Rect{-1, -1, 4, 4});
    CHECK(pyramid_taps({3, 5, 2, 4}) == Rect{5, 9, 6, 10});
    // Taps of neighbouring pixels overlap by two.
    const Rect a = pyramid_taps({3, 0, 1, 1});
    const Rect b = pyramid_taps({4, 0, 1, 1});
    CHECK(intersect(a, b).rows == 2);
}

TEST_CASE("level 0 searches what was asked, and every coarser range covers the finer one")
{
    for (int least = -70; least < 70; least += 7) {
        for (const int count : {1, 2, 15, 64, 100}) {
            const DisparityRange asked{least, least + count - 1};
            for (int levels = 1; levels <= 6; ++levels) {
                const auto ranges = pyramid_ranges(asked, levels);
                REQUIRE(static_cast<int>(ranges.size()) == levels);
                CHECK(ranges[0] == asked);
                for (std::size_t k = 1; k < ranges.size(); ++k) {
                    CHECK(floor_div(ranges[k - 1].min, 2) >= ranges[k].min);
                    CHECK(floor_div(ranges[k - 1].max, 2) <= ranges[k].max);
                    if (k >= 2) { // halves without remainder
                        CHECK(2 * ranges[k].min == ranges[k - 1].min);
                        CHECK(2 * ranges[k].max + 1 == ranges[k - 1].max);
                    }
                }
                // No wider than the rounding needs.
                CHECK(ranges.back().count() <= asked.count() / (1 << (levels - 1)) + 2);
            }
        }
    }
}

TEST_CASE("a range across zero is widened to whole coarse disparities")
{
    const auto ranges = pyramid_ranges({-64, 63}, 3);
    CHECK(ranges[1] == DisparityRange{-32, 31});
    CHECK(ranges[2] == DisparityRange{-16, 15});
    const auto odd = pyramid_ranges({-1, 1}, 3); // widened to -4..3
    CHECK(odd[0] == DisparityRange{-1, 1});
    CHECK(odd[1] == DisparityRange{-2, 1});
    CHECK(odd[2] == DisparityRange{-1, 0});
}
