#include "tests/catch.h"

#include "pipeline/geometry/reference_surface.h"

#include <cmath>

using namespace hsgm;
using namespace hsgm::geometry;

namespace {

// Posts of a function of (x, y), 9 x 10 of them, 20 m apart, the first at (1000, 2000).
template <typename Height>
ReferenceSurface surface_of(Height height)
{
    tiling::Image<double> posts({9, 10});
    for (int row = 0; row < 9; ++row) {
        for (int col = 0; col < 10; ++col) {
            posts(row, col) = height(1000.0 + 20 * col, 2000.0 - 20 * row);
        }
    }
    return {1000, 2000, 20, posts};
}

} // namespace

TEST_CASE("a level surface is level")
{
    const ReferenceSurface surface(321);
    double sx = 1;
    double sy = 1;
    CHECK(surface.height_m(5, 7, sx, sy) == 321);
    CHECK(sx == 0);
    CHECK(sy == 0);
    CHECK(surface.is_level());
}

TEST_CASE("a surface through the posts of a plane is that plane, slopes too")
{
    const auto plane = [](double x, double y) { return 100 + 0.2 * (x - 1000) - 0.1 * y; };
    const ReferenceSurface surface = surface_of(plane);
    for (double x = 1025; x < 1155; x += 7.3) {
        for (double y = 1865; y < 1975; y += 9.1) {
            double sx = 0;
            double sy = 0;
            CHECK(surface.height_m(x, y, sx, sy) == Approx(plane(x, y)));
            CHECK(sx == Approx(0.2));
            CHECK(sy == Approx(-0.1));
        }
    }
}

TEST_CASE("the slopes of a surface are those of its differences, and it has no steps")
{
    const ReferenceSurface surface =
        surface_of([](double x, double y) { return 50 * std::sin(x / 30) * std::cos(y / 25); });
    for (double x = 930; x < 1250; x += 3.7) {
        for (double y = 1780; y < 2060; y += 4.3) {
            double sx = 0;
            double sy = 0;
            const double h = surface.height_m(x, y, sx, sy);
            CHECK((surface.height_m(x + 1e-4, y) - h) / 1e-4 == Approx(sx).margin(2e-3));
            CHECK((surface.height_m(x, y + 1e-4) - h) / 1e-4 == Approx(sy).margin(2e-3));
        }
    }
}

TEST_CASE("beyond the outermost posts the heights go on")
{
    const ReferenceSurface surface = surface_of([](double x, double) { return x; });
    CHECK(surface.height_m(900, 1900) == Approx(1000));
    CHECK(surface.height_m(0, 1900) == Approx(1000));
    CHECK(surface.height_m(1000, 1900) == Approx(1000).margin(4));
    CHECK(surface.height_m(1e6, -1e6) == Approx(1180));
}
