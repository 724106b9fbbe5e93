#include "tests/catch.h"

#include "pipeline/synth/piece.h"
#include "pipeline/synth/terrain.h"
#include "tests/unit/synth/scenes.h"

#include <cmath>
#include <numbers>
#include <string>

using namespace hsgm::synth;

TEST_CASE("our sine is the sine")
{
    for (double turns = -3; turns < 3; turns += 0.0137) {
        REQUIRE(sine_of_turns(turns) ==
                Approx(std::sin(2 * std::numbers::pi * turns)).margin(1e-14));
    }
    CHECK(sine_of_turns(0) == 0);
    CHECK(cosine_of_turns(0) == Approx(1).epsilon(1e-15));
}

TEST_CASE("the terrain seen from the right is the terrain seen from the left")
{
    const TerrainSurface ground({10, 0.1, 0.2, {{8, 150, 10, 0}, {0.3, 40, 170, 30}}, {}});
    CHECK(ground.steepest_slope_x() < 0.5);
    for (double x = -50; x < 400; x += 3.7) {
        const double d = ground.disparity(x, 33);
        REQUIRE(ground.disparity_from_right(x - d, 33) == Approx(d).margin(1e-10));
    }
}

TEST_CASE("the terrain's slope is its derivative")
{
    const TerrainSurface ground({0, 0.1, 0, {{8, 150, 25, 70}}, {}});
    for (double x = 0; x < 200; x += 11) {
        const double difference =
            (ground.disparity(x + 1e-4, 9) - ground.disparity(x - 1e-4, 9));
        CHECK(ground.slope_x(x, 9) == Approx(difference / 2e-4).margin(1e-7));
    }
}

TEST_CASE("a turned rectangle covers the columns that lie inside it")
{
    Object object;
    object.center_x = 50;
    object.center_y = 40;
    object.length_px = 30;
    object.width_px = 12;
    object.angle_deg = 35;
    std::vector<Piece> pieces;
    for (const Shape shape : {Shape::rectangle, Shape::ellipse}) {
        object.shape = shape;
        append_pieces(object, 1, TerrainSurface({}), pieces);
    }
    REQUIRE(pieces.size() == 2);
    const double c = std::cos(35 * std::numbers::pi / 180);
    const double s = std::sin(35 * std::numbers::pi / 180);
    for (double y = 20.3; y < 60; y += 1) {
        for (double x = 20.1; x < 80; x += 1) {
            const double u = (x - 50) * c + (y - 40) * s;
            const double v = (y - 40) * c - (x - 50) * s;
            const bool in_rectangle = std::abs(u) < 15 && std::abs(v) < 6;
            const bool in_ellipse = u * u / 225 + v * v / 36 < 1;
            REQUIRE(span_on_row(pieces[0], View::left, y).covers(x) == in_rectangle);
            REQUIRE(span_on_row(pieces[1], View::left, y).covers(x) == in_ellipse);
        }
    }
}

TEST_CASE("a scene that would fold or alias is refused by name")
{
    Scene scene = testing::plane(0, 0.3);
    scene.terrain.waves = {{10, 100, 0, 0}};
    CHECK_THROWS_WITH(scene.validate(), Catch::Contains("slope of the terrain"));
    scene = testing::plane(0);
    scene.objects = {{Shape::rectangle, 0, 0, 10, 10, 0, 5, Roof::gable, 4, {}}};
    CHECK_THROWS_WITH(scene.validate(), Catch::Contains("objects[0]: the steepness"));
    scene = testing::plane(0);
    scene.bits = 7;
    CHECK_THROWS_WITH(scene.validate(), Catch::Contains("bits is 7; allowed: 8 to 16"));
}
