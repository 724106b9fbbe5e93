#include "tests/catch.h"

#include "pipeline/synth/overhead_renderer.h"

#include <cmath>

using namespace hsgm;
using namespace hsgm::synth;

namespace {

// One block of 20 x 10 cells and 12 m on flat ground of 2 m, in the middle of 60 x 60 cells.
Scene one_block()
{
    Scene scene;
    scene.size = {60, 60};
    scene.terrain.offset_px = 2;
    Object block;
    block.center_x = 30;
    block.center_y = 30;
    block.length_px = 20;
    block.width_px = 10;
    block.height_px = 12;
    scene.objects = {block};
    return scene;
}

const Area kAll{-100, 200, -100, 200};

} // namespace

TEST_CASE("rays meet ground, roofs and walls where geometry says")
{
    const Landscape landscape(one_block());
    const RayCaster caster(landscape, kAll);
    SECTION("from straight above")
    {
        const Hit ground = caster.first_hit({5, 5, 0, 0});
        CHECK(ground.surface == Surface::ground);
        CHECK(ground.height_m == Approx(2));
        const Hit roof = caster.first_hit({38, 33, 0, 0});
        CHECK(roof.surface == Surface::roof);
        CHECK(roof.height_m == Approx(14));
        CHECK(caster.first_hit({41, 30, 0, 0}).surface == Surface::ground);
    }
    SECTION("leaning to the east by half a cell a metre")
    {
        // Through the roof's eastern edge, x = 40 at 14 m: 33 at height 0.
        CHECK(caster.first_hit({32.9, 30, 0.5, 0}).surface == Surface::roof);
        const Hit wall = caster.first_hit({35, 30, 0.5, 0});
        CHECK(wall.surface == Surface::wall);
        CHECK(wall.height_m == Approx(10)); // where x = 40
        const Hit below = caster.first_hit({39.5, 30, 0.5, 0});
        CHECK(below.surface == Surface::ground);
        CHECK(below.height_m == Approx(2));
        // The western side is hidden: the ground there is met only left of the roof's shadow.
        const Hit hidden =
            caster.first_hit({20 - 1, 30, 0.5, 0}); // x = 20 at the ground, 26 above
        CHECK(hidden.surface == Surface::roof);
    }
    SECTION("a wall looks alike from two sides, and darker than its roof")
    {
        const Ray steep{36, 31, 0.4, 0};
        const Hit wall = caster.first_hit(steep);
        REQUIRE(wall.surface == Surface::wall);
        const Ray other{40 - 0.7 * wall.height_m, 31, 0.7, 0};
        const Hit again = caster.first_hit(other);
        REQUIRE(again.surface == Surface::wall);
        CHECK(again.height_m == Approx(wall.height_m));
        CHECK(caster.brightness(other, again) == Approx(caster.brightness(steep, wall)));
        CHECK(caster.brightness(steep, wall) < 0.4);
    }
}

TEST_CASE("hills are met where the ray is as high as they are")
{
    Scene scene;
    scene.size = {100, 100};
    scene.terrain.waves = {{5, 80, 20, 0}, {2, 37, 100, 10}};
    const Landscape landscape(scene);
    const RayCaster caster(landscape, kAll);
    for (int i = 0; i < 50; ++i) {
        const Ray ray{i * 1.9, 97 - i * 1.3, 0.4, -0.3};
        const double height_m = caster.first_hit(ray).height_m;
        CHECK(landscape.ground().disparity(ray.x_at(height_m), ray.y_at(height_m)) ==
              Approx(height_m).margin(1e-8));
    }
}

TEST_CASE("the map's truth tells heights, classes and what is seen")
{
    Scene scene = one_block();
    scene.low_texture = {{2, 2, 12, 12, 0.01}};
    const OverheadRenderer renderer(scene);
    const tiling::Rect all = rect_of(scene.size);
    tiling::Image<float> heights(scene.size);
    tiling::Image<std::uint8_t> classes(scene.size);
    tiling::Image<std::uint8_t> seen(scene.size);
    renderer.heights(all, heights.view());
    renderer.classes(all, classes.view());
    renderer.add_seen(
        [](double x, double y, double h) {
            return Ray{x - 0.5 * h, y, 0.5, 0};
        },
        2, all, seen.view());
    CHECK(heights(30, 30) == 14);
    CHECK(heights(30, 41) == 2);
    CHECK(classes(30, 30) == 1);
    CHECK(classes(8, 8) == 4);
    CHECK(classes(50, 50) == 0);
    // The camera is in the east, 0.5 cells a metre: 12 m hide 6 cells of ground in the west.
    CHECK(seen(30, 30) == 2);
    CHECK(seen(30, 45) == 2);
    CHECK(seen(30, 19) == 0);
    CHECK(seen(30, 15) == 0);
    CHECK(seen(30, 13) == 2);
    CHECK(seen(50, 17) == 2);
}

TEST_CASE("a part of an image from above has the pixels that the whole would have")
{
    Scene scene = one_block();
    scene.city = City{};
    scene.left.noise_gray = 2;
    const OverheadRenderer renderer(scene);
    const Camera camera(scene.left, {70, 80}, scene.full_scale(), 5);
    const RayOfPixel ray_of = [](double col, double row) {
        return Ray{col - 3, row - 2, 0.3, -0.2};
    };
    tiling::Image<std::uint16_t> whole({70, 80});
    renderer.render(ray_of, camera, rect_of(whole.size()), whole.view());
    const tiling::Rect part{13, 21, 30, 41};
    tiling::Image<std::uint16_t> piece(part.size());
    renderer.render(ray_of, camera, part, piece.view());
    for (int row = 0; row < part.rows; ++row) {
        for (int col = 0; col < part.cols; ++col) {
            REQUIRE(piece(row, col) == whole(part.row + row, part.col + col));
        }
    }
}
