// Cells from points, with answers worked out by hand.

#include "pipeline/dsm/cell_block.h"

#include "tests/catch.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace hsgm::dsm;
using hsgm::tiling::Rect;

namespace {

struct Sample {
    double x;
    double y;
    double height;
    std::uint8_t confidence;
};

DsmGrid metre_grid(int rows, int cols)
{
    DsmGrid grid;
    grid.size = {rows, cols};
    return grid; // cell (r, c) has its centre at (c + 0.5, -r - 0.5)
}

Cells cells_of(const DsmGrid& grid, const Rect& part, const std::vector<Sample>& points,
               const CellOptions& options = {})
{
    CellBlock block(grid, part, options);
    for (const Sample& p : points) {
        block.add(p.x, p.y, p.height, p.confidence);
    }
    return block.finish();
}

// A rolling surface with a step, and points where two surfaces lie above each other.
std::vector<Sample> many_points()
{
    std::vector<Sample> points;
    std::uint32_t state = 7;
    const auto next = [&state] {
        state = state * 1664525U + 1013904223U;
        return (state >> 8) / double(1 << 24);
    };
    for (int i = 0; i < 3000; ++i) {
        const double x = 40 * next() - 4;
        const double y = -30 * next() + 3;
        const double height = std::sin(x / 3) + std::cos(y / 4) + (x > 17 ? 9 * next() : 0);
        points.push_back({x, y, height, static_cast<std::uint8_t>(1 + 250 * next())});
    }
    return points;
}

} // namespace

TEST_CASE("a point at the centre of a cell gives the cell its height")
{
    const Cells cells = cells_of(metre_grid(2, 3), {0, 0, 2, 3}, {{1.5, -0.5, 12.25, 200}});
    CHECK(cells.height(0, 1) == 12.25F);
    CHECK(cells.spread(0, 1) == 0.0F);
    CHECK(cells.points(0, 1) == 1);
    CHECK(cells.confidence(0, 1) == 200);
    // The other centres are a metre away or more, which is out of the radius.
    CHECK(cells.height(0, 0) == kNoHeight);
    CHECK(cells.height(1, 1) == kNoHeight);
    CHECK(cells.spread(0, 0) == kNoHeight);
    CHECK(cells.confidence(0, 0) == 0);
    CHECK(cells.points(0, 0) == 0);
}

TEST_CASE("nearer and more confident points count for more")
{
    // Squared distances 0.25 and 0.5 of a squared radius of 1: weights 9/16 and 1/4.
    const double d = std::sqrt(0.5);
    const Cells near = cells_of(metre_grid(1, 1), {0, 0, 1, 1},
                                {{0.5, 0.0, 10, 100}, {0.5 + d, -0.5, 10.5, 100}});
    CHECK(near.height(0, 0) == Approx(10 + 0.5 * 0.25 / (0.25 + 0.5625)));
    CHECK(near.points(0, 0) == 2);
    const Cells sure =
        cells_of(metre_grid(1, 1), {0, 0, 1, 1}, {{0.25, -0.5, 10, 50}, {0.75, -0.5, 11, 150}});
    CHECK(sure.height(0, 0) == Approx(10.75));
    CHECK(sure.confidence(0, 0) == 125);
    CHECK(sure.spread(0, 0) == Approx(std::sqrt(0.25 * 0.75 * 0.75 + 0.75 * 0.25 * 0.25)));
}

TEST_CASE("of two surfaces the one of more weight wins, and nothing is mixed")
{
    const std::vector<Sample> points{
        {0.5, -0.5, 30, 100}, {0.6, -0.5, 30.5, 100}, {0.4, -0.6, 5, 100}};
    CHECK(cells_of(metre_grid(1, 1), {0, 0, 1, 1}, points).height(0, 0) > 30);
    // Ground at the centre, a roof at the rim.
    const std::vector<Sample> rim{{0.5, -0.5, 5, 100}, {1.2, -0.5, 30, 100}};
    CHECK(cells_of(metre_grid(1, 1), {0, 0, 1, 1}, rim).height(0, 0) == 5.0F);
    // The surer that there is another surface, the less sure is this one: weights of 1 and
    // 0.51^2 on either side, and none at all where both are one layer.
    const double beside = std::pow(1 - 0.7 * 0.7, 2);
    CHECK(cells_of(metre_grid(1, 1), {0, 0, 1, 1}, rim).confidence(0, 0) ==
          std::floor(100 / (1 + beside) + 0.5));
    const std::vector<Sample> together{{0.5, -0.5, 5, 100}, {1.2, -0.5, 5.5, 100}};
    CHECK(cells_of(metre_grid(1, 1), {0, 0, 1, 1}, together).confidence(0, 0) == 100);
    // Of equals the higher one, as seen from above.
    const std::vector<Sample> equal{{0.25, -0.5, 5, 100}, {0.75, -0.5, 30, 100}};
    CHECK(cells_of(metre_grid(1, 1), {0, 0, 1, 1}, equal).height(0, 0) == 30.0F);
}

TEST_CASE("cells do not depend on the order of points nor on how the grid is cut")
{
    const DsmGrid grid = metre_grid(24, 32);
    const Rect all = rect_of(grid.size);
    auto points = many_points();
    CellOptions options;
    options.radius = 1.3;
    const Cells whole = cells_of(grid, all, points, options);
    CHECK(std::count(whole.points.pixels().begin(), whole.points.pixels().end(), 0) < 20);
    std::reverse(points.begin(), points.end());
    std::rotate(points.begin(), points.begin() + 1234, points.end());
    CHECK(cells_of(grid, all, points, options).height == whole.height);
    for (int row = 0; row < 24; row += 7) {
        for (int col = 0; col < 32; col += 9) {
            const Rect part = intersect({row, col, 7, 9}, all);
            const Cells cells = cells_of(grid, part, points, options);
            for (int r = 0; r < part.rows; ++r) {
                for (int c = 0; c < part.cols; ++c) {
                    REQUIRE(cells.height(r, c) == whole.height(row + r, col + c));
                    REQUIRE(cells.spread(r, c) == whole.spread(row + r, col + c));
                    REQUIRE(cells.points(r, c) == whole.points(row + r, col + c));
                    REQUIRE(cells.confidence(r, c) == whole.confidence(row + r, col + c));
                }
            }
        }
    }
}

TEST_CASE("a slope sampled evenly keeps its heights")
{
    std::vector<Sample> points;
    for (double x = -2; x < 12; x += 0.5) {
        for (double y = 2; y > -12; y -= 0.5) {
            points.push_back({x, y, 3 + 0.4 * x - 0.2 * y, 200});
        }
    }
    const DsmGrid grid = metre_grid(8, 8);
    const Cells cells = cells_of(grid, rect_of(grid.size), points);
    for (int r = 0; r < 8; ++r) {
        for (int c = 0; c < 8; ++c) {
            CHECK(cells.height(r, c) ==
                  Approx(3 + 0.4 * grid.x(c) - 0.2 * grid.y(r)).margin(1e-5));
        }
    }
}
