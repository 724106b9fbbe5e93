#include "tests/catch.h"

#include "pipeline/geometry/disparity_bounds.h"
#include "pipeline/geometry/error.h"
#include "pipeline/geometry/overlap.h"
#include "tests/unit/geometry/sample_cameras.h"
#include "tests/unit/geometry/sample_models.h"
#include "tests/unit/geometry/words.h"

#include <limits>
#include <random>

using namespace hsgm;
using namespace hsgm::geometry;
using samples::says;

namespace {

TiePoint at_disparity(double d)
{
    return {{10, 100}, {10, 100 - d}};
}

} // namespace

TEST_CASE("a wrong tie point in fifty does not widen the range")
{
    std::vector<TiePoint> points;
    for (int i = 0; i <= 98; ++i) {
        points.push_back(at_disparity(i * 0.1));
    }
    points.push_back(at_disparity(833));
    points.push_back(at_disparity(-500));
    const auto bounds = bounds_of(points);
    REQUIRE(bounds.has_value());
    CHECK(bounds->min_px >= 0);
    CHECK(bounds->min_px < 0.3);
    CHECK(bounds->max_px <= 9.8);
    CHECK(bounds->max_px > 9.5);
    CHECK_FALSE(bounds_of(std::span(points).first(19)).has_value());
}

TEST_CASE("the range of a disparity map holds its small tower and not its noise")
{
    tiling::Image<float> map({300, 400}, 5.0F);
    std::mt19937 random(4);
    std::uniform_int_distribution<int> row(0, 299);
    std::uniform_int_distribution<int> col(0, 399);
    std::uniform_int_distribution<int> wild(-500, 500);
    for (int i = 0; i < 3000; ++i) {
        map(row(random), col(random)) = static_cast<float>(wild(random));
    }
    for (int r = 100; r < 112; ++r) {
        for (int c = 200; c < 212; ++c) {
            map(r, c) = 42.0F; // 144 px of 120000
        }
    }
    for (int r = 0; r < 50; ++r) {
        for (int c = 0; c < 60; ++c) {
            map(r, c) = std::numeric_limits<float>::quiet_NaN();
        }
    }
    const auto bounds = bounds_of(map.view());
    REQUIRE(bounds.has_value());
    CHECK(bounds->min_px == 5);
    CHECK(bounds->max_px == 42);
    CHECK(bounds->low_gap_px == 0);
    CHECK(bounds->high_gap_px >= 36); // between ground and roof
}

TEST_CASE("a disparity map of noise has no range")
{
    tiling::Image<float> map({100, 100});
    std::mt19937 random(4);
    std::uniform_int_distribution<int> wild(-500, 500);
    for (int i = 0; i < 10000; ++i) {
        map.data()[i] = static_cast<float>(wild(random));
    }
    CHECK_FALSE(bounds_of(map.view()).has_value());
}

TEST_CASE("parts of scenes share most at the right height")
{
    samples::ParallelCamera left;
    samples::ParallelCamera right;
    left.lean_x = 0.3;
    right.lean_x = -0.3;
    // Cut so that they show the same ground at 700 m: the left one begins 210 m further west
    // at height 0, the right one 210 m further east.
    left.west = -210;
    right.west = 210;
    const tiling::Size size{800, 1000};
    const Overlap overlap = find_overlap(left, size, right, size, {-500, 2500});
    CHECK(overlap.level_m == Approx(700).margin(30));
    CHECK(overlap.area_m2 == Approx(799 * 0.5 * 999 * 0.5).epsilon(0.03));
    // A metre up moves them apart by 0.6 m; a tenth of 499.5 m is left at 749 m more.
    CHECK(overlap.shared.low_m == Approx(700 - 749).margin(50));
    CHECK(overlap.shared.high_m == Approx(700 + 749).margin(50));
    right.west = 5000;
    const auto refusal = [&] {
        try {
            find_overlap(left, size, right, size, {-500, 2500});
        } catch (const GeometryError& error) {
            return std::string(error.what());
        }
        return std::string("no refusal");
    };
    CHECK(says(refusal(), "the images do not overlap: at 1000 m the left one shows 0.2 km2"));
}

TEST_CASE("models are for the heights that both are for")
{
    RpcModel a = samples::model(); // 500 +- 500
    RpcModel b = a;
    b.height_off_m = 900;
    b.height_scale_m = 300;
    CHECK(heights_of(a, b).low_m == 600);
    CHECK(heights_of(a, b).high_m == 1000);
    b.height_off_m = 2000;
    CHECK_THROWS_AS(heights_of(a, b), GeometryError);
}
