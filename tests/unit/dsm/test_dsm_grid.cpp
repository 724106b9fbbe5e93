#include "pipeline/dsm/dsm_grid.h"

#include "tests/catch.h"

#include <array>
#include <stdexcept>

using namespace hsgm::dsm;
using hsgm::tiling::Rect;
using hsgm::tiling::Size;

TEST_CASE("a grid covers its bounds with lines on multiples of the cell")
{
    Bounds bounds;
    bounds.include(100.3, 49.9);
    bounds.include(101.1, 48.6);
    const DsmGrid grid = make_grid(bounds, 0.5);
    CHECK(grid.west() == 100.0);
    CHECK(grid.north() == 50.0);
    CHECK(grid.size == Size{3, 3});
    CHECK(grid.x(0) == 100.25);
    CHECK(grid.y(0) == 49.75);
    CHECK(grid.transform() == std::array<double, 6>{100, 0.5, 0, 50, 0, -0.5});
    const Bounds part = grid.bounds(Rect{1, 1, 1, 2});
    CHECK(part.west == 100.5);
    CHECK(part.east == 101.5);
    CHECK(part.north == 49.5);
    CHECK(part.south == 49.0);
}

TEST_CASE("a grid that begins elsewhere fits the first one")
{
    Bounds bounds;
    bounds.include(-7.2, -3.1);
    bounds.include(-6.1, 4.4);
    const DsmGrid small = make_grid(bounds, 0.3);
    bounds.include(-11, 9.7);
    const DsmGrid large = make_grid(bounds, 0.3);
    const auto down = static_cast<int>(small.first_row - large.first_row);
    const auto right = static_cast<int>(small.first_col - large.first_col);
    CHECK(small.x(1) == large.x(1 + right));
    CHECK(small.y(2) == large.y(2 + down));
}

TEST_CASE("a grid of nothing, or of no size, or of too many cells is refused")
{
    Bounds bounds;
    CHECK(bounds.empty());
    CHECK_THROWS_AS(make_grid(bounds, 1), std::invalid_argument);
    bounds.include(0, 0);
    CHECK_THROWS_AS(make_grid(bounds, 0), std::invalid_argument);
    bounds.include(1e12, 0);
    CHECK_THROWS_AS(make_grid(bounds, 1e-3), std::invalid_argument);
}

TEST_CASE("bounds meet where they share something, within a margin")
{
    Bounds a;
    a.include(0, 0);
    a.include(2, 2);
    Bounds b;
    b.include(3, 0);
    b.include(4, 1);
    CHECK_FALSE(a.meets(b, 0));
    CHECK(a.meets(b, 1));
    CHECK_FALSE(a.meets(Bounds{}, 1e9));
    Bounds both = a;
    both.include(b);
    both.include(Bounds{});
    CHECK(both.east == 4);
    CHECK(both.meets(b, 0));
}

TEST_CASE("the cell is a round number near the ground sampling distance")
{
    CHECK(cell_for(0.5) == 0.5);
    CHECK(cell_for(0.487) == 0.5);
    CHECK(cell_for(0.311) == 0.3);
    CHECK(cell_for(1.02) == 1.0);
    CHECK(cell_for(2.4) == 2.5);
    CHECK(cell_for(9.9) == 10.0);
    CHECK(cell_for(0.098) == 0.1);
}
