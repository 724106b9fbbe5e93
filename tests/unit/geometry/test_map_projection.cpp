#include "tests/catch.h"

#include "pipeline/geometry/map_projection.h"
#include "tests/unit/geometry/words.h"

#include <cmath>
#include <string>

using namespace hsgm::geometry;
using samples::says;

namespace {

std::string refusal(const std::string& crs, const std::string& vertical = "")
{
    try {
        MapProjection::from_text(crs, vertical);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "no refusal";
}

} // namespace

TEST_CASE("the automatic map is the UTM zone of the place")
{
    CHECK(MapProjection::automatic(55.7, -21.2).name() == "WGS 84 / UTM zone 40S");
    CHECK(MapProjection::automatic(31.1, 29.97).name() == "WGS 84 / UTM zone 36N");
    CHECK(MapProjection::automatic(-180, 10).name() == "WGS 84 / UTM zone 1N");
    CHECK(MapProjection::automatic(180, 10).name() == "WGS 84 / UTM zone 1N");
    CHECK(MapProjection::automatic(179.99, -10).name() == "WGS 84 / UTM zone 60S");
    CHECK(says(MapProjection::automatic(0, 85).name(), "UPS North"));
    CHECK(says(MapProjection::automatic(0, -81).name(), "UPS South"));
}

TEST_CASE("UTM coordinates are those that can be looked up")
{
    // The central meridian on the equator is false easting, 500 km; a degree of latitude there
    // is 110574.4 m along the ellipsoid, times 0.9996.
    const MapProjection map = MapProjection::from_text("EPSG:32636");
    const MapPoint equator = map.forward({33, 0, 123.5});
    CHECK(equator.x == Approx(500000));
    CHECK(equator.y == Approx(0).margin(1e-6));
    CHECK(equator.height_m == Approx(123.5));
    CHECK(map.forward({33, 1, 0}).y == Approx(110574.389 * 0.9996).margin(0.01));
    CHECK(map.in_metres());
    CHECK(says(map.height_name(), "WGS84 ellipsoid"));
}

TEST_CASE("maps lead there and back")
{
    for (const char* crs : {"EPSG:32740", "EPSG:2975", "EPSG:3857", "EPSG:4326", "EPSG:5042"}) {
        CAPTURE(crs);
        const MapProjection map = MapProjection::from_text(crs);
        const GeodeticPoint ground{55.7, -21.2, 2300};
        const GeodeticPoint back = map.inverse(map.forward(ground));
        CHECK(std::abs(back.longitude_deg - ground.longitude_deg) < 1e-10);
        CHECK(std::abs(back.latitude_deg - ground.latitude_deg) < 1e-10);
        CHECK(std::abs(back.height_m - ground.height_m) < 1e-5);
    }
    CHECK_FALSE(MapProjection::from_text("EPSG:4326").in_metres());
    CHECK_FALSE(MapProjection::from_text("EPSG:2263").in_metres()); // New York, feet
}

TEST_CASE("heights above EGM96 are those above the ellipsoid less the undulation")
{
    // Undulations: Giza +15.4 m, Reunion +1.9 m. The node of EGM96's 15' grid at 37 E, 37.5 N
    // holds 32.3813 m, its neighbour at 36.75 E, 37.25 N 31.6630 m.
    const MapProjection map = MapProjection::from_text("EPSG:32636", "egm96");
    CHECK(map.forward({31.13, 29.98, 75}).height_m == Approx(75 - 15.4).margin(0.1));
    CHECK(map.inverse(map.forward({31.13, 29.98, 75})).height_m == Approx(75));
    CHECK(map.height_name() == "EGM96 height");
    CHECK(says(map.wkt(), "COMPOUNDCRS"));
    const MapProjection written = MapProjection::from_text("EPSG:32740+5773");
    CHECK(written.forward({55.71, -21.23, 2339}).height_m == Approx(2339 - 1.9).margin(0.1));
    const MapProjection turkey = MapProjection::from_text("EPSG:32637", "EPSG:5773");
    CHECK(turkey.forward({37, 37.5, 700}).height_m == Approx(700 - 32.3813).margin(1e-3));
    CHECK(turkey.forward({36.75, 37.25, 700}).height_m == Approx(700 - 31.6630).margin(1e-3));
}

TEST_CASE("a copy of a map is the same map")
{
    const MapProjection map = MapProjection::from_text("EPSG:32740", "EGM96");
    const MapProjection copy = map.copy();
    const MapPoint a = map.forward({55.7, -21.2, 2300});
    const MapPoint b = copy.forward({55.7, -21.2, 2300});
    CHECK(a.x == b.x);
    CHECK(a.y == b.y);
    CHECK(a.height_m == b.height_m);
    CHECK(copy.wkt() == map.wkt());
}

TEST_CASE("coordinate reference systems that cannot be used are refused with the reason")
{
    CHECK(says(refusal("EPSG:99999"), "'EPSG:99999' is no coordinate reference system"));
    CHECK(says(refusal("somewhere"), "write for example EPSG:32740"));
    CHECK(says(refusal("EPSG:4978"), "is no map"));
    CHECK(says(refusal("EPSG:5773"), "is no map"));
    CHECK(says(refusal("EPSG:32740", "EPSG:32740"), "is no vertical datum"));
    CHECK(says(refusal("EPSG:32740+5773", "EGM96"), "a vertical datum of its own"));
    CHECK(says(refusal("EPSG:32740", "EGM2008"), "which is not installed"));
}
