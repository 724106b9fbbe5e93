#include "tests/catch.h"

#include "pipeline/stages/frame_patches.h"

using namespace hsgm;
using tiling::Rect;

TEST_CASE("patches are spread evenly, lie inside, and are no more than asked for")
{
    const auto patches = pipeline::spread_patches({1000, 2000}, 100, 4);
    REQUIRE(patches.size() == 16);
    CHECK(patches.front() == Rect{75, 200, 100, 100});
    CHECK(patches[1] == Rect{75, 700, 100, 100});
    CHECK(patches.back() == Rect{825, 1700, 100, 100});
}

TEST_CASE("a small image is one patch, or as many as it has room for")
{
    const auto whole = pipeline::spread_patches({60, 70}, 100, 4);
    REQUIRE(whole.size() == 1);
    CHECK(whole.front() == Rect{0, 0, 60, 70});
    CHECK(pipeline::spread_patches({200, 340}, 100, 4).size() == 6);
    const auto pixel = pipeline::spread_patches({1, 1}, 100, 4);
    REQUIRE(pixel.size() == 1);
    CHECK(pixel.front() == Rect{0, 0, 1, 1});
}
