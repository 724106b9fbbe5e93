#include "tests/catch.h"

#include "pipeline/geometry/error.h"
#include "pipeline/geometry/ground_lattice.h"
#include "pipeline/geometry/ortho_model.h"
#include "pipeline/geometry/relief_warp.h"
#include "pipeline/geometry/sensor_model.h"

#include <cmath>
#include <limits>
#include <numbers>

using namespace hsgm;
using namespace hsgm::geometry;

namespace {

constexpr const char* kUtm = "EPSG:32633";
constexpr double kWest = 500'000;
constexpr double kNorth = 5'300'000;

/// 400 x 300 px of half a metre; rays move by (0.2, -0.1) m per metre up.
OrthoModel model()
{
    OrthoModel m;
    m.size = {300, 400};
    m.grid = MapGrid({kWest, 0.5, 0, kNorth, 0, -0.5});
    m.crs = kUtm;
    m.level_m = 300;
    m.slope_x = 0.2;
    m.slope_y = -0.1;
    return m;
}

/// Heights of 290 + 0.1 m per metre to the east, 20 m posts round the image.
std::shared_ptr<const ElevationGrid> ramp()
{
    tiling::Image<float> posts({14, 16});
    for (int r = 0; r < posts.rows(); ++r) {
        for (int c = 0; c < posts.cols(); ++c) {
            posts(r, c) = static_cast<float>(290 + 0.1 * 20 * (c - 3));
        }
    }
    // The fourth post of a row lies on the image's western edge.
    return std::make_shared<ElevationGrid>(MapGrid({kWest - 70, 20, 0, kNorth + 70, 0, -20}),
                                           kUtm, std::move(posts));
}

} // namespace

TEST_CASE("a map grid knows pixels by their centres, turned ones too")
{
    const MapGrid grid({1000, 2, 0, 500, 0, -2});
    CHECK(grid.place_of({0, 0}).x == 1001);
    CHECK(grid.place_of({0, 0}).y == 499);
    CHECK(grid.pixel_of(1003, 495).x == 1);
    CHECK(grid.pixel_of(1003, 495).y == 2);
    CHECK(grid.step() == 2);
    const MapGrid turned({10, 0.6, 0.8, 20, 0.8, -0.6});
    const MapPoint place = turned.place_of({7.25, -3});
    CHECK(turned.pixel_of(place.x, place.y).x == Approx(7.25));
    CHECK(turned.pixel_of(place.x, place.y).y == Approx(-3));
    // Pixel 0 of an image of a quarter of the size lies in the middle of the first 4 x 4.
    const MapPoint coarse = turned.reduced(4).place_of({0, 0});
    const MapPoint middle = turned.place_of({1.5, 1.5});
    CHECK(coarse.x == Approx(middle.x));
    CHECK(coarse.y == Approx(middle.y));
    CHECK_THROWS_AS(MapGrid({0, 0, 0, 0, 0, 1}), GeometryError);
}

TEST_CASE("an elevation grid is bilinear between posts and ends half a post outside")
{
    tiling::Image<float> posts({2, 3});
    const float heights[] = {1, 3, 5, 11, 13, std::numeric_limits<float>::quiet_NaN()};
    std::copy(std::begin(heights), std::end(heights), posts.data());
    const ElevationGrid grid(MapGrid({0, 1, 0, 0, 0, -1}), kUtm, std::move(posts));
    CHECK(grid.height_m({0, 0}) == 1);
    CHECK(grid.height_m({0.25, 0}) == 1.5);
    CHECK(grid.height_m({0.5, 0.5}) == 7);
    CHECK(grid.height_m({-0.4, 1.4}) == 11);
    CHECK(std::isnan(grid.height_m({-0.6, 0})));
    CHECK(std::isnan(grid.height_m({0, 1.6})));
    CHECK(std::isnan(grid.height_m({1.5, 0.5})));
    CHECK(grid.height_m({2, 0}) == 5); // the missing post has no weight
    CHECK(grid.height_m({1, 1}) == 13);
    CHECK(grid.lowest_m() == 1);
    CHECK(grid.highest_m() == 13);
    CHECK(std::isnan(grid.height_m({std::numeric_limits<double>::quiet_NaN(), 0})));
}

TEST_CASE("an orthoimage on a plane shows heights beside their places")
{
    const MapProjection map = MapProjection::from_text(kUtm);
    const OrthoGroundCamera camera(model(), {}, map);
    // On the plane: where the map says.
    const ImagePoint flat = camera.project({kWest + 100.25, kNorth - 50.25, 300});
    CHECK(flat.x == Approx(200).margin(1e-6));
    CHECK(flat.y == Approx(100).margin(1e-6));
    // 40 m above it: 8 m to the west (X' = X - b (h - r)) and 4 m to the north.
    const ImagePoint raised = camera.project({kWest + 100.25, kNorth - 50.25, 340});
    CHECK(raised.x == Approx(200 - 16).margin(1e-6));
    CHECK(raised.y == Approx(100 - 8).margin(1e-6));
    const auto back = camera.locate(raised, 340);
    REQUIRE(back);
    CHECK(back->x == Approx(kWest + 100.25).margin(1e-6));
    CHECK(back->y == Approx(kNorth - 50.25).margin(1e-6));
    // A correction is added to where the model says, and taken off on the way back.
    const ImageCorrection correction{1.5, 1e-3, 0, -2, 0, 2e-3};
    const OrthoGroundCamera moved(model(), correction, map);
    const ImagePoint there = moved.project({kWest + 100.25, kNorth - 50.25, 300});
    CHECK(there.x == Approx(200 + 1.5 + 0.2).margin(1e-6));
    CHECK(there.y == Approx(100 - 2 + 0.2).margin(1e-6));
    const auto same = moved.locate(there, 300);
    REQUIRE(same);
    CHECK(same->x == Approx(kWest + 100.25).margin(1e-6));
    CHECK(same->y == Approx(kNorth - 50.25).margin(1e-6));
}

TEST_CASE("azimuth and incidence mean the way to the satellite, from true north")
{
    const MapProjection map = MapProjection::from_text(kUtm);
    const OrthoModel m = model();
    const double aside = std::tan(20 * std::numbers::pi / 180);
    // On the central meridian, the map's north is true; its scale there is 0.9996.
    const ImagePoint east = slope_of_view(m.grid, m.size, map, 90, 20);
    CHECK(east.x == Approx(0.9996 * aside).epsilon(1e-6));
    CHECK(east.y == Approx(0).margin(1e-4));
    const ImagePoint north = slope_of_view(m.grid, m.size, map, 0, 20);
    CHECK(north.y == Approx(0.9996 * aside).epsilon(1e-6));
    // 2 degrees further east at 47.8 north, the map's north is turned by 2 sin(47.8) degrees.
    const MapPoint far = map.forward({17, 47.8, 0});
    const MapGrid away({far.x, 0.5, 0, far.y, 0, -0.5});
    const ImagePoint turned = slope_of_view(away, {2, 2}, map, 0, 20);
    CHECK(std::atan2(-turned.x, turned.y) * 180 / std::numbers::pi ==
          Approx(2 * std::sin(47.8 * std::numbers::pi / 180)).epsilon(1e-3));
    // A vector is along a metric map's axes as it is; degrees are metres over the radius.
    CHECK(slope_of_vector(m.grid, m.size, map, 0.3, 0.4).x == 0.3);
    const MapProjection degrees = MapProjection::from_text("EPSG:4326");
    const MapGrid fine({15, 5e-6, 0, 47.8, 0, -5e-6});
    const ImagePoint up = slope_of_vector(fine, {2, 2}, degrees, 0, 1);
    CHECK(up.y == Approx(1 / 111190.0).epsilon(1e-3));
    CHECK(up.x == Approx(0).margin(1e-12));
}

TEST_CASE("an orthoimage on a DEM is read where the levelled image says")
{
    const auto dem = ramp();
    OrthoModel m = model();
    m.margin_px = 20;
    CHECK(m.levelled_size() == tiling::Size{340, 440});
    const OrthoGroundCamera camera(m, {}, MapProjection::from_text(kUtm));
    const ReliefWarp warp(m, dem);
    for (const double h : {300.0, 317.0}) {
        for (const double east : {30.0, 77.7, 150.1}) {
            const MapPoint place{kWest + east, kNorth - 60.6, h};
            const ImagePoint pixel = warp.source_of(camera.project(place));
            // X = X' + b (h - r(X')), with r of the ramp
            const double x = (pixel.x + 0.5) * 0.5;
            const double y = -(pixel.y + 0.5) * 0.5;
            const double above = h - (290 + 0.1 * x);
            CHECK(x + 0.2 * above == Approx(east).margin(1e-3));
            CHECK(y - 0.1 * above == Approx(-60.6).margin(1e-3));
        }
    }
    CHECK_FALSE(std::isfinite(warp.source_of({5000, 100}).x));
    // The DEM ends 190 m east of the image's western edge, 10 m before the image does.
    CHECK(std::isfinite(warp.source_of({20 + 370, 100}).x));
    const ReliefWarp nowhere(
        m, std::make_shared<ElevationGrid>(
               MapGrid({kWest - 70, 20, 0, kNorth + 70, 0, -20}), kUtm,
               tiling::Image<float>({14, 16}, std::numeric_limits<float>::quiet_NaN())));
    CHECK_FALSE(std::isfinite(nowhere.source_of({200, 100}).x));
}

TEST_CASE("a reduced orthoimage's model does what the full one's does")
{
    OrthoModel m = model();
    m.margin_px = 30;
    const SensorModel full(m, ImageCorrection{0.5, 0, 1e-3, 1, 0, 0});
    const SensorModel coarse = full.reduced(4);
    const MapProjection map = MapProjection::from_text(kUtm);
    const MapPoint place{kWest + 44, kNorth - 70, 322};
    const ImagePoint fine = full.over(map)->project(place);
    const ImagePoint found = coarse.over(map)->project(place);
    CHECK(found.x == Approx((fine.x - 1.5) / 4).margin(1e-6));
    CHECK(found.y == Approx((fine.y - 1.5) / 4).margin(1e-6));
}

TEST_CASE("rays of orthoimages on two maps meet where the ground is")
{
    const MapProjection map = MapProjection::from_text(kUtm);
    OrthoModel left = model();
    OrthoModel right = model();
    right.crs = "EPSG:4326";
    const GeodeticPoint corner = map.inverse({kWest, kNorth, 0});
    right.grid = MapGrid({corner.longitude_deg, 7e-6, 0, corner.latitude_deg, 0, -5e-6});
    const ImagePoint slope =
        slope_of_view(right.grid, right.size, MapProjection::from_text(right.crs), 250, 15);
    right.slope_x = slope.x;
    right.slope_y = slope.y;
    const OrthoGroundCamera a(left, {}, map);
    const OrthoGroundCamera b(right, {}, map);
    const MapPoint place{kWest + 60, kNorth - 40, 333};
    const auto meeting =
        meet_rays(a, a.project(place), b, b.project(place), {place.x + 5, place.y, 310});
    REQUIRE(meeting);
    CHECK(meeting->place.x == Approx(place.x).margin(1e-4));
    CHECK(meeting->place.y == Approx(place.y).margin(1e-4));
    CHECK(meeting->place.height_m == Approx(333).margin(1e-4));
    CHECK(meeting->residual_px < 1e-4);
}
