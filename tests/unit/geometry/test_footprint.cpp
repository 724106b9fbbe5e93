#include "tests/catch.h"

#include "pipeline/geometry/error.h"
#include "pipeline/geometry/footprint.h"
#include "tests/unit/geometry/sample_cameras.h"
#include "tests/unit/geometry/sample_models.h"

using namespace hsgm;
using namespace hsgm::geometry;

namespace {

Polygon square(double west, double south, double side)
{
    return {{west, south, 0},
            {west + side, south, 0},
            {west + side, south + side, 0},
            {west, south + side, 0}};
}

} // namespace

TEST_CASE("the common part of two squares is a square")
{
    const Polygon both = intersection(square(0, 0, 10), square(6, 7, 10));
    CHECK(area_m2(both) == Approx(4 * 3));
    CHECK(area_m2(intersection(square(0, 0, 10), square(2, 3, 4))) == Approx(16));
    CHECK(area_m2(intersection(square(2, 3, 4), square(0, 0, 10))) == Approx(16));
    CHECK(area_m2(intersection(square(0, 0, 10), square(0, 0, 10))) == Approx(100));
}

TEST_CASE("squares that are apart have nothing in common")
{
    CHECK(intersection(square(0, 0, 10), square(11, 0, 10)).empty());
    CHECK(intersection(square(0, 0, 10), {}).empty());
}

TEST_CASE("a square turned by 45 degrees cuts the corners off another")
{
    const Polygon diamond{{5, -2, 0}, {12, 5, 0}, {5, 12, 0}, {-2, 5, 0}};
    // Each corner loses a right triangle with legs of 3.
    CHECK(area_m2(intersection(square(0, 0, 10), diamond)) == Approx(100 - 4 * 4.5));
}

TEST_CASE("the footprint of an upright camera is its rectangle, whatever the direction")
{
    samples::ParallelCamera camera;
    camera.west = 500;
    camera.north = 900;
    camera.gsd_m = 2;
    const Footprint upright = footprint(camera, {11, 21}, ReferenceSurface(0));
    CHECK(area_m2(upright.corners) == Approx(20 * 10 * 4));
    CHECK(upright.bulge_m == Approx(0).margin(1e-9));
    camera.turn_rad = 3.14159265358979;
    const Footprint turned = footprint(camera, {11, 21}, ReferenceSurface(0));
    CHECK(area_m2(intersection(upright.corners, turned.corners)) == Approx(0).margin(1e-6));
    CHECK(area_m2(turned.corners) == Approx(800));
}

TEST_CASE("a leaning ray meets a slope where a hand finds it")
{
    samples::ParallelCamera camera;
    camera.lean_x = 0.5;
    tiling::Image<double> posts({6, 6});
    for (int row = 0; row < 6; ++row) {
        for (int col = 0; col < 6; ++col) {
            posts(row, col) = 100.0 * col * 0.2; // rises 0.2 m a metre to the east
        }
    }
    const ReferenceSurface slope(0, 500, 100, posts);
    // Pixel (500, 200) sees x = 250 + 0.5 h, and h = 0.2 x there: x = 250 / 0.9.
    const auto place = meet_surface(camera, {500, -200}, slope);
    REQUIRE(place.has_value());
    CHECK(place->x == Approx(250 / 0.9));
    CHECK(place->height_m == Approx(50 / 0.9));
    const auto lifted = meet_surface(camera, {500, -200}, slope, 18);
    REQUIRE(lifted.has_value());
    CHECK(lifted->x == Approx((250 + 9) / 0.9));
    CHECK(lifted->height_m == Approx(0.2 * lifted->x + 18));
}

TEST_CASE("an image whose model does not reach the ground has no footprint")
{
    RpcModel flat = samples::model();
    flat.line_num = flat.samp_num;
    flat.line_den = flat.samp_den;
    const RpcGroundCamera camera(RpcCamera(flat), MapProjection::automatic(7, 45));
    CHECK_THROWS_AS(footprint(camera, {100, 200}, ReferenceSurface(500)), GeometryError);
}
