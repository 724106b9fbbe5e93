// Which cells lie in a part of the map, with answers read off a sketch.

#include "pipeline/dsm/cell_area.h"

#include "tests/catch.h"

#include <string>

using namespace hsgm::dsm;

namespace {

DsmGrid metre_grid(int rows, int cols)
{
    DsmGrid grid;
    grid.size = {rows, cols};
    return grid; // cell (r, c) has its centre at (c + 0.5, -r - 0.5)
}

std::string marks(const CellArea& area, const DsmGrid& grid, int row, int col = 0)
{
    std::vector<std::uint8_t> inside(static_cast<std::size_t>(grid.size.cols - col));
    area.mark(grid, row, col, inside);
    std::string text;
    for (const std::uint8_t mark : inside) {
        text += mark != 0 ? '#' : '.';
    }
    return text;
}

Ring box(double west, double south, double east, double north)
{
    return {{west, south}, {east, south}, {east, north}, {west, north}};
}

} // namespace

TEST_CASE("cells whose centres a ring surrounds are inside, whichever way it runs")
{
    const DsmGrid grid = metre_grid(4, 8);
    Ring ring = box(1, -3, 5.4, -1);
    for (int turned = 0; turned < 2; ++turned) {
        const CellArea area({ring});
        CHECK(marks(area, grid, 0) == "........");
        CHECK(marks(area, grid, 1) == ".####...");
        CHECK(marks(area, grid, 2) == ".####...");
        CHECK(marks(area, grid, 3) == "........");
        std::reverse(ring.begin(), ring.end());
    }
}

TEST_CASE("rings in rings are holes, and islands in them")
{
    const DsmGrid grid = metre_grid(7, 9);
    const CellArea area({box(0, -7, 9, 0), box(2, -5, 7, -2), box(4, -4, 5, -3)});
    CHECK(marks(area, grid, 0) == "#########");
    CHECK(marks(area, grid, 2) == "##.....##");
    CHECK(marks(area, grid, 3) == "##..#..##");
    CHECK(area.bounds().west == 0);
    CHECK(area.bounds().north == 0);
}

TEST_CASE("a corner at the height of a row of centres counts once")
{
    // A diamond whose left and right corners lie at y -2.5, that of row 2.
    const CellArea area({{{4, -0.2}, {7.2, -2.5}, {4, -4.8}, {0.8, -2.5}}});
    const DsmGrid grid = metre_grid(5, 8);
    CHECK(marks(area, grid, 2) == ".######.");
    CHECK(marks(area, grid, 1) == "..####..");
    CHECK(marks(area, grid, 3) == "..####..");
}

TEST_CASE("a cell has the same answer wherever the question begins")
{
    const CellArea area({{{0.3, -6}, {7.7, -4.1}, {3.3, 0}}});
    const DsmGrid grid = metre_grid(6, 8);
    for (int row = 0; row < 6; ++row) {
        const std::string whole = marks(area, grid, row);
        for (int col = 0; col < 8; ++col) {
            CHECK(marks(area, grid, row, col) == whole.substr(static_cast<std::size_t>(col)));
        }
    }
    CHECK(CellArea({{{0, 0}, {1, 1}}}).empty());
}
