#include "tests/catch.h"

#include "tests/reference/paths.h"
#include "tests/unit/reference/images.h"

#include <set>

using namespace hsgm::reference;

namespace {

PixelCosts costs(DisparityRange range, std::vector<std::uint32_t> values)
{
    PixelCosts result(range);
    result.values = std::move(values);
    return result;
}

} // namespace

TEST_CASE("the twin's directions are distinct and as many as asked")
{
    for (const int paths : {4, 5, 8, 16}) {
        std::set<std::pair<int, int>> seen;
        for (const Step step : directions(paths)) {
            seen.insert({step.rows, step.cols});
        }
        CHECK(static_cast<int>(seen.size()) == paths);
    }
}

TEST_CASE("the twin's penalties fall with the gradient")
{
    CHECK(gradient_penalty(24, 192, 5, 0) == 192);
    CHECK(gradient_penalty(24, 192, 5, 5) == 108);
    CHECK(gradient_penalty(24, 192, 5, 255) == 27); // 24 + 840 / 260
    CHECK(gradient_penalty(24, 192, 10, 5) == 136); // 24 + 1680 / 15
    CHECK(gradient_penalty(24, 192, 10, 10) == 108);
    CHECK(paper_penalty(24, 192, 0) == 192);
    CHECK(paper_penalty(24, 192, 1) == 108);
    CHECK(paper_penalty(24, 192, 255) == 24);
}

TEST_CASE("the twin's eq. 1 follows a line worked out by hand")
{
    const DisparityRange range{-1, 1};
    const PixelCosts first = costs(range, {3, 0, 4});
    const PixelCosts second = path_costs(costs(range, {1, 6, 0}), first, 2, 5);
    CHECK(second.values == std::vector<std::uint32_t>{3, 6, 2});
    const PixelCosts third = path_costs(costs(range, {0, 0, 9}), second, 2, 5);
    CHECK(third.values == std::vector<std::uint32_t>{1, 2, 9});
    const PixelCosts fourth = path_costs(costs(range, {7, 7, 7}), third, 2, 5);
    CHECK(fourth.values == std::vector<std::uint32_t>{7, 8, 10});
    // A jump from the minimum: 1 + 2 at d = 1 instead of 2 + 2 from its neighbour.
    CHECK(path_costs(costs(range, {0, 0, 0}), third, 2, 2).values ==
          std::vector<std::uint32_t>{0, 1, 2});
}

TEST_CASE("the twin's eq. 1 knows a range of one disparity")
{
    CHECK(path_costs(costs({5, 5}, {9}), costs({5, 5}, {30}), 2, 5).values ==
          std::vector<std::uint32_t>{9});
}

TEST_CASE("the twin's coarse start halves disparities downwards and averages odd ones")
{
    const PixelCosts coarse = costs({-1, 1}, {5, 3, 10}); // v = 2 0 7, 30 elsewhere
    CHECK(coarse_start(coarse, {-4, 3}, 6, true).values ==
          std::vector<std::uint32_t>{30, 16, 2, 1, 0, 4, 7, 19});
    CHECK(coarse_start(coarse, {10, 11}, 6, true).values == std::vector<std::uint32_t>{30, 30});
    CHECK(coarse_start(coarse, {10, 10}, 4000, false).values ==
          std::vector<std::uint32_t>{4024});
}

TEST_CASE("the twin cuts an image into cells of the grid")
{
    const auto windows = grid_windows({100, 130}, 64);
    REQUIRE(windows.size() == 6);
    CHECK(windows[1].core == Rect{0, 64, 64, 64});
    CHECK(windows[5].core == Rect{64, 128, 36, 2});
}

TEST_CASE("the twin's regions reach out where a path comes from, within the image")
{
    const Rect core{64, 64, 64, 64};
    const Size image{200, 130};
    CHECK(path_region(core, {0, 1}, 8, image) == Rect{64, 56, 64, 72});
    CHECK(path_region(core, {0, -1}, 8, image) == Rect{64, 64, 64, 66});
    CHECK(path_region(core, {1, -1}, 8, image) == Rect{56, 64, 72, 66});
    CHECK(path_region(core, {-2, 1}, 8, image) == Rect{64, 56, 72, 72});
    CHECK(path_region({0, 0, 64, 64}, {1, 1}, 8, image) == Rect{0, 0, 64, 64});
}

TEST_CASE("the twin's pruned range is the coarse one, doubled, with a margin")
{
    const Image<int> ten({4, 4}, 10);
    const Rect core{0, 0, 8, 8};
    // 16..25 are ten disparities; six more, three of them below.
    CHECK(pruned_range(core, ten, {0, 63}) == DisparityRange{13, 28});
    CHECK(pruned_range(core, ten, {20, 63}) == DisparityRange{20, 35});
    CHECK(pruned_range(core, ten, {0, 24}) == DisparityRange{9, 24});
    CHECK(pruned_range(core, ten, {0, 15}) == DisparityRange{0, 15});
    CHECK(pruned_range(core, ten, {0, 16}) == DisparityRange{1, 16});

    const auto step = image_of<int>({{10, 10, 20, 20}, {10, 10, 20, 20}});
    CHECK(pruned_range({0, 0, 4, 8}, step, {0, 63}) == DisparityRange{15, 46});
    const auto negative = image_of<int>({{-3, -3, -3}, {-3, -3, -3}, {-3, -3, -3}});
    CHECK(pruned_range({0, 0, 6, 6}, negative, {-64, 63}) == DisparityRange{-13, 2});
}

TEST_CASE("the twin's pruned range drops two medians at either end, if there are five")
{
    // Medians of the four pixels are 2 2 3 3.
    CHECK(pruned_range({0, 0, 4, 4}, image_of<int>({{1, 2}, {3, 4}}), {-99, 99}) ==
          DisparityRange{-2, 13});
    // One row: medians are those of three columns, 0 0 1 9 9 and 1 is left of them.
    const auto row = image_of<int>({{0, 0, 1, 9, 9}});
    CHECK(median_winner(row, 0, 1) == 0);
    CHECK(median_winner(row, 0, 2) == 1);
    CHECK(median_winner(row, 0, 3) == 9);
    CHECK(pruned_range({0, 0, 1, 10}, row, {-99, 99}) == DisparityRange{-5, 10});
    // A window sees one coarse pixel beyond its footprint: here 0 0 0 | 9.
    const auto edge = image_of<int>({{0, 0, 0, 9, 9, 9}});
    CHECK(pruned_range({0, 0, 2, 4}, edge, {-99, 99}) == DisparityRange{-7, 8});
    CHECK(pruned_range({0, 0, 2, 6}, edge, {-99, 99}) == DisparityRange{-6, 25});
}
