// Why cells have no height, from the pixels that would lie in them.

#include "pipeline/dsm/reason_block.h"

#include "tests/catch.h"

#include <vector>

using namespace hsgm::dsm;
using hsgm::tiling::Rect;

namespace {

struct Hole {
    double x;
    double y;
    Missing reason;
};

DsmGrid metre_grid(int rows, int cols)
{
    DsmGrid grid;
    grid.size = {rows, cols};
    return grid;
}

ReasonBlock with(const DsmGrid& grid, const Rect& cells, const std::vector<Hole>& holes)
{
    ReasonBlock block(grid, cells, 1.2);
    for (const Hole& hole : holes) {
        block.add(hole.x, hole.y, hole.reason);
    }
    return block;
}

} // namespace

TEST_CASE("a cell takes the reason of most of its pixels, the lower number of equals")
{
    const DsmGrid grid = metre_grid(3, 3);
    const ReasonBlock block = with(grid, rect_of(grid.size),
                                   {{0.2, -0.2, Missing::uncertain},
                                    {0.7, -0.3, Missing::occluded},
                                    {0.4, -0.9, Missing::uncertain},
                                    {2.5, -0.5, Missing::uncertain},
                                    {2.6, -0.5, Missing::occluded}});
    CHECK(block.most(0, 0) == Missing::uncertain);
    CHECK(block.most(0, 2) == Missing::occluded);
}

TEST_CASE("a cell without pixels asks the cells round it, nearer ones first")
{
    const DsmGrid grid = metre_grid(9, 9);
    const ReasonBlock block = with(grid, rect_of(grid.size),
                                   {{4.5, -4.5, Missing::masked_left},
                                    {6.5, -4.5, Missing::occluded},
                                    {6.6, -4.5, Missing::occluded}});
    CHECK(block.most(4, 4) == Missing::masked_left);
    CHECK(block.most(4, 3) == Missing::masked_left);
    CHECK(block.most(4, 5) == Missing::occluded);    // two of them, as near as the other
    CHECK(block.most(2, 2) == Missing::masked_left); // two cells away
    CHECK(block.most(1, 1) == Missing::none);        // three cells away: nothing is known
    const ReasonBlock nothing = with(grid, rect_of(grid.size), {});
    CHECK(nothing.most(4, 4) == Missing::none);
}

TEST_CASE("a cell has the same reason in every block, in whatever order pixels come")
{
    const DsmGrid grid = metre_grid(12, 12);
    std::vector<Hole> holes;
    for (int i = 0; i < 60; ++i) {
        holes.push_back({(i * 37 % 120) / 10.0, -(i * 53 % 120) / 10.0,
                         static_cast<Missing>(1 + i * 7 % 9)});
    }
    const ReasonBlock whole = with(grid, rect_of(grid.size), holes);
    std::reverse(holes.begin(), holes.end());
    for (const int size : {1, 3, 5}) {
        for (int row = 0; row < 12; row += size) {
            for (int col = 0; col < 12; col += size) {
                const Rect part = intersect({row, col, size, size}, rect_of(grid.size));
                const ReasonBlock block = with(grid, part, holes);
                for (int r = 0; r < part.rows; ++r) {
                    for (int c = 0; c < part.cols; ++c) {
                        CHECK(block.most(r, c) == whole.most(row + r, col + c));
                    }
                }
            }
        }
    }
}
