#include "tests/catch.h"

#include "pipeline/geometry/rpc_camera.h"
#include "tests/unit/geometry/sample_models.h"

#include <cmath>
#include <random>
#include <vector>

using namespace hsgm::geometry;

namespace {

std::vector<GeodeticPoint> random_grounds(const RpcModel& m, int count, unsigned seed = 1)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<GeodeticPoint> points;
    for (int i = 0; i < count; ++i) {
        const double l = unit(random);
        const double p = unit(random);
        const double h = unit(random);
        points.push_back({m.long_off_deg + l * m.long_scale_deg,
                          m.lat_off_deg + p * m.lat_scale_deg,
                          m.height_off_m + h * m.height_scale_m});
    }
    return points;
}

} // namespace

TEST_CASE("a model of one term each gives what a hand can work out")
{
    RpcModel m;
    m.samp_off = 100;
    m.samp_scale = 10;
    m.line_off = 200;
    m.line_scale = 20;
    m.long_off_deg = 7;
    m.long_scale_deg = 0.5;
    m.lat_off_deg = 45;
    m.lat_scale_deg = 0.25;
    m.height_off_m = 50;
    m.height_scale_m = 100;
    m.samp_num[1] = 1; // longitude
    m.samp_den[0] = 2;
    m.line_num[2] = -1; // latitude
    m.line_num[18] = 3; // latitude squared times height
    m.line_den[0] = 1;
    const ImagePoint point = RpcCamera(m).project({7.25, 45.125, 100});
    CHECK(point.x == Approx(100 + 10 * (0.5 / 2)));
    CHECK(point.y == Approx(200 + 20 * (-0.5 + 3 * 0.25 * 0.5)));
}

TEST_CASE("locating what was projected leads back")
{
    const RpcCamera camera(samples::model());
    for (const GeodeticPoint& ground : random_grounds(camera.model(), 1000)) {
        const auto back = camera.locate(camera.project(ground), ground.height_m);
        REQUIRE(back.has_value());
        REQUIRE(std::abs(back->longitude_deg - ground.longitude_deg) < 1e-10);
        REQUIRE(std::abs(back->latitude_deg - ground.latitude_deg) < 1e-10);
        REQUIRE(back->height_m == ground.height_m);
    }
}

TEST_CASE("derivatives of the projection are those of its differences")
{
    const ImageCorrection correction{1.5, 1e-3, -2e-3, -0.5, 3e-3, 2e-3};
    const RpcCamera camera(samples::model(), correction);
    const auto difference = [&](GeodeticPoint p, double GeodeticPoint::*by, double step) {
        p.*by += step;
        const ImagePoint after = camera.project(p);
        p.*by -= 2 * step;
        const ImagePoint before = camera.project(p);
        return ImagePoint{(after.x - before.x) / (2 * step), (after.y - before.y) / (2 * step)};
    };
    for (const GeodeticPoint& ground : random_grounds(camera.model(), 50)) {
        ImageJacobian j;
        const ImagePoint point = camera.project(ground, j);
        CHECK(point.x == Approx(camera.project(ground).x).epsilon(1e-14));
        CHECK(point.y == Approx(camera.project(ground).y).epsilon(1e-14));
        const ImagePoint l = difference(ground, &GeodeticPoint::longitude_deg, 1e-5);
        const ImagePoint p = difference(ground, &GeodeticPoint::latitude_deg, 1e-5);
        const ImagePoint h = difference(ground, &GeodeticPoint::height_m, 0.1);
        CHECK(j.x_by_first == Approx(l.x).epsilon(1e-6).margin(1e-2));
        CHECK(j.y_by_first == Approx(l.y).epsilon(1e-6).margin(1e-2));
        CHECK(j.x_by_second == Approx(p.x).epsilon(1e-6).margin(1e-2));
        CHECK(j.y_by_second == Approx(p.y).epsilon(1e-6).margin(1e-2));
        CHECK(j.x_by_height == Approx(h.x).epsilon(1e-6).margin(1e-7));
        CHECK(j.y_by_height == Approx(h.y).epsilon(1e-6).margin(1e-7));
    }
}

TEST_CASE("many points at once are the points one by one, to the bit")
{
    const RpcCamera camera(samples::model(), {0.25, 0, 1e-4, 1, 0, 0});
    const auto grounds = random_grounds(camera.model(), 37);
    std::vector<double> lon;
    std::vector<double> lat;
    std::vector<double> height;
    for (const GeodeticPoint& g : grounds) {
        lon.push_back(g.longitude_deg);
        lat.push_back(g.latitude_deg);
        height.push_back(g.height_m);
    }
    std::vector<double> x(grounds.size());
    std::vector<double> y(grounds.size());
    camera.project(lon, lat, height, x, y);
    std::vector<double> lon_back(grounds.size());
    std::vector<double> lat_back(grounds.size());
    camera.locate(x, y, height, lon_back, lat_back);
    for (std::size_t i = 0; i < grounds.size(); ++i) {
        REQUIRE(x[i] == camera.project(grounds[i]).x);
        REQUIRE(y[i] == camera.project(grounds[i]).y);
        const auto back = camera.locate({x[i], y[i]}, height[i]);
        REQUIRE(back.has_value());
        REQUIRE(lon_back[i] == back->longitude_deg);
        REQUIRE(lat_back[i] == back->latitude_deg);
    }
}

TEST_CASE("a part of an image has the model of the whole, moved")
{
    const RpcModel whole = samples::model();
    const RpcCamera camera(whole);
    const RpcCamera part(crop(whole, {1200, 345.5}));
    const GeodeticPoint ground{7.01, 45.02, 640};
    CHECK(part.project(ground).x == Approx(camera.project(ground).x - 1200));
    CHECK(part.project(ground).y == Approx(camera.project(ground).y - 345.5));
}

TEST_CASE("a reduced image has the model of the whole, reduced")
{
    const RpcModel whole = samples::model();
    const GeodeticPoint ground{7.01, 45.02, 640};
    const ImagePoint fine = RpcCamera(whole).project(ground);
    const ImagePoint coarse = RpcCamera(reduced(whole, 4)).project(ground);
    // Coarse pixel 0 holds the pixels 0 to 3, from -0.5 to 3.5.
    CHECK((coarse.x + 0.5) * 4 == Approx(fine.x + 0.5));
    CHECK((coarse.y + 0.5) * 4 == Approx(fine.y + 0.5));
}

TEST_CASE("a model with negative scales is an image turned by 180 degrees")
{
    const RpcModel upright = samples::model();
    RpcModel turned = upright;
    turned.samp_off = 19999 - upright.samp_off;
    turned.line_off = 19999 - upright.line_off;
    turned.samp_scale = -upright.samp_scale;
    turned.line_scale = -upright.line_scale;
    const GeodeticPoint ground{7.03, 44.98, 410};
    const ImagePoint a = RpcCamera(upright).project(ground);
    const ImagePoint b = RpcCamera(turned).project(ground);
    CHECK(b.x == Approx(19999 - a.x));
    CHECK(b.y == Approx(19999 - a.y));
    const auto back = RpcCamera(turned).locate(b, 410);
    REQUIRE(back.has_value());
    CHECK(back->longitude_deg == Approx(7.03));
}

TEST_CASE("a correction moves image points, and locating takes it into account")
{
    const GeodeticPoint ground{7.01, 45.02, 640};
    const ImagePoint plain = RpcCamera(samples::model()).project(ground);
    const RpcCamera camera(samples::model(), {2, 1e-4, 0, -3, 0, 2e-4});
    const ImagePoint moved = camera.project(ground);
    CHECK(moved.x == Approx(plain.x + 2 + 1e-4 * plain.x));
    CHECK(moved.y == Approx(plain.y - 3 + 2e-4 * plain.y));
    const auto back = camera.locate(moved, 640);
    REQUIRE(back.has_value());
    CHECK(back->latitude_deg == Approx(45.02).epsilon(1e-12));
}

TEST_CASE("a scene across the date line is one scene")
{
    RpcModel m = samples::model();
    m.long_off_deg = 179.99;
    const RpcCamera camera(m);
    const ImagePoint beyond = camera.project({180.01, 45, 500});
    const ImagePoint wrapped = camera.project({-179.99, 45, 500});
    CHECK(wrapped.x == Approx(beyond.x));
    const auto back = camera.locate(beyond, 500);
    REQUIRE(back.has_value());
    CHECK(back->longitude_deg == Approx(-179.99));
}

TEST_CASE("what cannot be located is not there")
{
    RpcModel flat = samples::model();
    flat.line_num = flat.samp_num;
    flat.line_den = flat.samp_den; // line equals sample: points off the diagonal are nowhere
    const RpcCamera camera(flat);
    CHECK_FALSE(camera.locate({100, 9000}, 500).has_value());
    std::vector<double> x{100};
    std::vector<double> y{9000};
    std::vector<double> h{500};
    std::vector<double> lon(1);
    std::vector<double> lat(1);
    camera.locate(x, y, h, lon, lat);
    CHECK(std::isnan(lon[0]));
    CHECK(std::isnan(lat[0]));
}
