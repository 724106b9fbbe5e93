#include "tests/catch.h"

#include "pipeline/geometry/error.h"
#include "pipeline/geometry/relief_surface.h"

#include <cmath>
#include <limits>

using namespace hsgm;
using namespace hsgm::geometry;

namespace {

constexpr const char* kUtm = "EPSG:32633";
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// 40 x 40 posts of 10 m from (500000, 5300000): 100 m, rising by 0.2 to the east and 0.1 to
/// the south.
tiling::Image<float> slope()
{
    tiling::Image<float> posts({40, 40});
    for (int r = 0; r < 40; ++r) {
        for (int c = 0; c < 40; ++c) {
            posts(r, c) = static_cast<float>(100 + 2 * (c + 0.5) + (r + 0.5));
        }
    }
    return posts;
}

ElevationGrid grid(tiling::Image<float> posts)
{
    return {MapGrid({500'000, 10, 0, 5'300'000, 0, -10}), kUtm, std::move(posts)};
}

const MapBox kInside{500'100, 5'299'700, 500'300, 5'299'900};

} // namespace

TEST_CASE("a reference DEM's surface is the DEM where that is a slope")
{
    const MapProjection map = MapProjection::from_text(kUtm);
    const ReliefSurface relief = relief_surface(grid(slope()), map, kInside, 30);
    CHECK(relief.covered == 1);
    for (const double east : {100.0, 163.0, 300.0}) {
        CHECK(relief.surface.height_m(500'000 + east, 5'299'777) ==
              Approx(100 + 0.2 * east + 0.1 * 223).margin(1e-3));
    }
    // Only where it goes on level does the surface leave the slope.
    CHECK(relief.dem_below_m <= 0);
    CHECK(relief.dem_above_m >= 0);
    CHECK(relief.lowest_m < relief.surface.height_m(kInside.west, kInside.north));
    CHECK(relief.highest_m > relief.surface.height_m(kInside.east, kInside.south));
    // Lifted by a metre, everything lies a metre higher.
    CHECK(relief.surface.lifted(1).height_m(500'200, 5'299'800) ==
          Approx(relief.surface.height_m(500'200, 5'299'800) + 1));
    CHECK(ReferenceSurface(7).lifted(-2).level_m() == 5);
}

TEST_CASE("a surface smoother than its DEM says how far the DEM leaves it")
{
    auto posts = slope();
    posts(20, 20) += 30; // a hill of one post
    const ReliefSurface relief =
        relief_surface(grid(std::move(posts)), MapProjection::from_text(kUtm), kInside, 50);
    CHECK(relief.dem_above_m > 20);
    CHECK(relief.dem_above_m < 30);
    CHECK(relief.dem_below_m < 0);
}

TEST_CASE("gaps of a reference DEM take the heights beside them, and are told")
{
    const MapProjection map = MapProjection::from_text(kUtm);
    auto posts = slope();
    for (int r = 0; r < 40; ++r) {
        for (int c = 20; c < 40; ++c) {
            posts(r, c) = kNone;
        }
    }
    const ReliefSurface relief = relief_surface(grid(std::move(posts)), map, kInside, 20);
    CHECK(relief.covered > 0.4);
    CHECK(relief.covered < 0.6);
    CHECK(relief.highest_m < 100 + 0.2 * 200 + 0.1 * 400);
    const double edge = relief.surface.height_m(500'180, 5'299'800);
    CHECK(relief.surface.height_m(500'290, 5'299'800) == Approx(edge).margin(6));
    CHECK_THROWS_AS(
        relief_surface(grid(tiling::Image<float>({40, 40}, kNone)), map, kInside, 20),
        GeometryError);
    const MapBox outside{510'000, 5'299'700, 510'200, 5'299'900};
    CHECK_THROWS_AS(relief_surface(grid(slope()), map, outside, 20), GeometryError);
}
