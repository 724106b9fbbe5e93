#include "tests/catch.h"

#include "tiling/rect.h"

using namespace hsgm::tiling;

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
