#include "tests/catch.h"

#include "tiling/image.h"
#include "tiling/tile_plan.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <vector>

using namespace hsgm::tiling;

namespace {

// How often the cores cover every pixel.
Image<int> coverage(const TilePlan& plan)
{
    Image<int> times(plan.raster());
    for (int tile = 0; tile < plan.count(); ++tile) {
        const Rect core = plan.core(tile);
        for (int row = core.row; row < core.row_end(); ++row) {
            for (int col = core.col; col < core.col_end(); ++col) {
                ++times(row, col);
            }
        }
    }
    return times;
}

bool is_permutation_of_tiles(std::vector<int> sequence, const TilePlan& plan)
{
    std::sort(sequence.begin(), sequence.end());
    std::vector<int> all(static_cast<std::size_t>(plan.count()));
    std::iota(all.begin(), all.end(), 0);
    return sequence == all;
}

} // namespace

TEST_CASE("tile cores cover every pixel exactly once")
{
    for (const int rows : {1, 2, 7, 64, 65}) {
        for (const int cols : {1, 3, 63, 64, 100}) {
            for (const int tile : {0, 1, 2, 5, 33, 64, 99, 1000}) {
                const TilePlan plan({rows, cols}, tile);
                const auto times = coverage(plan);
                const auto pixels = times.pixels();
                INFO(rows << " x " << cols << ", tiles of " << tile);
                CHECK(std::all_of(pixels.begin(), pixels.end(), [](int n) { return n == 1; }));
                CHECK(plan.count() == (tile == 0 ? 1
                                                 : ceil_div(rows, std::min(tile, rows)) *
                                                       ceil_div(cols, std::min(tile, cols))));
            }
        }
    }
}

TEST_CASE("tiles are numbered row by row and those at the edge are smaller")
{
    const TilePlan plan({100, 150}, 64);
    CHECK(plan.count() == 6);
    CHECK(plan.core(0) == Rect{0, 0, 64, 64});
    CHECK(plan.core(2) == Rect{0, 128, 64, 22});
    CHECK(plan.core(3) == Rect{64, 0, 36, 64});
    CHECK(plan.core(5) == Rect{64, 128, 36, 22});
}

TEST_CASE("an untiled plan has one tile")
{
    const TilePlan plan({100, 150}, 0);
    CHECK(plan.count() == 1);
    CHECK(plan.core(0) == Rect{0, 0, 100, 150});
}

TEST_CASE("a plan without pixels or with a negative tile size is refused")
{
    CHECK_THROWS_AS(TilePlan({0, 5}, 64), std::invalid_argument);
    CHECK_THROWS_AS(TilePlan({5, -1}, 64), std::invalid_argument);
    CHECK_THROWS_WITH(TilePlan({5, 5}, -3), Catch::Matchers::Contains("-3"));
}

TEST_CASE("every order visits every tile once")
{
    for (const Size raster : {Size{1, 1}, Size{100, 150}, Size{40, 700}}) {
        for (const int tile : {0, 7, 64}) {
            const TilePlan plan(raster, tile);
            for (const TileOrder order : {TileOrder::rows, TileOrder::columns,
                                          TileOrder::reversed, TileOrder::shuffled}) {
                CHECK(is_permutation_of_tiles(tile_sequence(plan, order, 3), plan));
            }
        }
    }
}

TEST_CASE("orders are what their names say")
{
    const TilePlan plan({2, 3}, 1); // 0 1 2
                                    // 3 4 5
    CHECK(tile_sequence(plan, TileOrder::rows) == std::vector{0, 1, 2, 3, 4, 5});
    CHECK(tile_sequence(plan, TileOrder::columns) == std::vector{0, 3, 1, 4, 2, 5});
    CHECK(tile_sequence(plan, TileOrder::reversed) == std::vector{5, 4, 3, 2, 1, 0});
}

TEST_CASE("shuffling depends on the seed alone")
{
    const TilePlan plan({50, 50}, 5);
    const auto shuffled = tile_sequence(plan, TileOrder::shuffled, 1);
    CHECK(shuffled == tile_sequence(plan, TileOrder::shuffled, 1));
    CHECK(shuffled != tile_sequence(plan, TileOrder::shuffled, 2));
    CHECK(shuffled != tile_sequence(plan, TileOrder::rows));
}
