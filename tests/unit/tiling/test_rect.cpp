#include "tests/catch.h"

#include "tiling/disparity_range.h"
#include "tiling/rect.h"

#include <cmath>
#include <random>

using namespace hsgm::tiling;

namespace {

// Small rectangles round the origin, empty ones among them.
class RandomRects {
public:
    Rect next() { return {between(-9, 9), between(-9, 9), between(0, 12), between(0, 12)}; }
    Rect next_with_pixels()
    {
        return {between(-9, 9), between(-9, 9), between(1, 12), between(1, 12)};
    }
    int between(int least, int most)
    {
        return least + static_cast<int>(random_() % unsigned(most - least + 1));
    }

private:
    std::mt19937 random_{17};
};

template <typename Check>
void for_pixels_nearby(Check check)
{
    for (int row = -30; row < 30; ++row) {
        for (int col = -30; col < 30; ++col) {
            check(row, col);
        }
    }
}

} // namespace

TEST_CASE("halving a rectangle keeps every pixel inside its coarser pixel")
{
    for (int row = -5; row < 6; ++row) {
        for (int rows = 1; rows < 6; ++rows) {
            const Rect half = halve(Rect{row, row + 1, rows, rows + 1});
            CHECK(half.row == floor_div(row, 2));
            CHECK(half.row_end() == floor_div(row + rows - 1, 2) + 1);
            CHECK(half.col == floor_div(row + 1, 2));
            CHECK(half.col_end() == floor_div(row + 1 + rows, 2) + 1);
        }
    }
}

TEST_CASE("division rounds down and up also below zero")
{
    for (int a = -20; a <= 20; ++a) {
        for (int b = 1; b < 7; ++b) {
            CHECK(floor_div(a, b) == static_cast<int>(std::floor(double(a) / b)));
            CHECK(ceil_div(a, b) == static_cast<int>(std::ceil(double(a) / b)));
        }
    }
}

TEST_CASE("an intersection holds the pixels of both and no other")
{
    RandomRects random;
    for (int i = 0; i < 60; ++i) {
        const Rect a = random.next();
        const Rect b = random.next();
        const Rect both = intersect(a, b);
        bool right = true;
        for_pixels_nearby([&](int row, int col) {
            right &= both.contains(row, col) == (a.contains(row, col) && b.contains(row, col));
        });
        CHECK(right);
        CHECK(both.rows >= 0);
        CHECK(both.area() == intersect(b, a).area());
        CHECK(a.contains(both));
    }
}

TEST_CASE("a union is the smallest rectangle with the pixels of both")
{
    RandomRects random;
    for (int i = 0; i < 60; ++i) {
        const Rect a = random.next();
        const Rect b = random.next();
        const Rect all = unite(a, b);
        CHECK(all.contains(a));
        CHECK(all.contains(b));
        if (!a.empty() && !b.empty()) {
            CHECK(all.row == std::min(a.row, b.row));
            CHECK(all.col == std::min(a.col, b.col));
            CHECK(all.row_end() == std::max(a.row_end(), b.row_end()));
            CHECK(all.col_end() == std::max(a.col_end(), b.col_end()));
        }
    }
    CHECK(unite(Rect{3, 4, 0, 9}, Rect{1, 2, 3, 4}) == Rect{1, 2, 3, 4});
    CHECK(unite(Rect{1, 2, 3, 4}, Rect{}) == Rect{1, 2, 3, 4});
}

TEST_CASE("rounding out gives the fewest whole cells of the global grid")
{
    RandomRects random;
    for (int i = 0; i < 200; ++i) {
        const Rect r = random.next_with_pixels();
        const int cell = random.between(1, 8);
        const Rect out = round_out(r, cell);
        CHECK(out.contains(r));
        for (const int edge : {out.row, out.col, out.row_end(), out.col_end()}) {
            CHECK(edge == floor_div(edge, cell) * cell);
        }
        CHECK(r.row - out.row < cell);
        CHECK(r.col - out.col < cell);
        CHECK(out.row_end() - r.row_end() < cell);
        CHECK(out.col_end() - r.col_end() < cell);
        CHECK(round_out(out, cell) == out);
    }
}

TEST_CASE("a rectangle that is empty has no area and is inside any other")
{
    const Rect none{5, 5, 0, 7};
    CHECK(none.empty());
    CHECK(none.area() == 0);
    CHECK(Rect{0, 0, 1, 1}.contains(none));
    CHECK_FALSE(none.contains(5, 5));
    CHECK(round_out(none, 8).empty());
    CHECK(halve(none).empty());
}

TEST_CASE("areas beyond 2 to the power of 31 do not overflow")
{
    CHECK(Size{50'000, 50'000}.area() == 2'500'000'000);
    CHECK(Rect{0, 0, 60'000, 60'000}.area() == 3'600'000'000);
}

TEST_CASE("the right reach of a rectangle holds every counterpart of every pixel")
{
    const Rect left{2, 10, 3, 4};
    for (const DisparityRange range : {DisparityRange{0, 0}, {-5, 3}, {7, 9}, {-9, -6}}) {
        const Rect seen = right_reach(left, range);
        CHECK(seen.row == left.row);
        CHECK(seen.rows == left.rows);
        CHECK(seen.col == left.col - range.max);
        CHECK(seen.col_end() == left.col_end() - range.min);
    }
}
