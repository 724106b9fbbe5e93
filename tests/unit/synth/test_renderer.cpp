#include "tests/catch.h"

#include "tests/unit/synth/scenes.h"

#include <cmath>
#include <stdexcept>

using namespace hsgm;
using namespace hsgm::synth;
using namespace hsgm::synth::testing;

TEST_CASE("a scene rendered in parts equals the scene rendered whole")
{
    const Renderer r(small_city());
    const auto left = image(r, View::left);
    const auto right = image(r, View::right);
    const auto truth_left = truth(r, View::left);
    const auto truth_right = truth(r, View::right);
    const auto visible_left = visible(r, View::left);
    const auto visible_right = visible(r, View::right);
    for (const tiling::Rect part : {tiling::Rect{0, 0, 7, 700}, tiling::Rect{61, 333, 50, 191},
                                    tiling::Rect{149, 699, 1, 1}}) {
        tiling::Patch<std::uint16_t> a(part);
        tiling::Patch<std::uint16_t> b(part);
        tiling::Patch<float> c(part);
        tiling::Patch<float> d(part);
        tiling::Patch<std::uint8_t> e(part);
        tiling::Patch<std::uint8_t> f(part);
        r.render_left(part, a.pixels);
        r.render_right(part, b.pixels);
        r.truth_left(part, c.pixels);
        r.truth_right(part, d.pixels);
        r.visible_left(part, e.pixels);
        r.visible_right(part, f.pixels);
        int differing = 0;
        for (int row = part.row; row < part.row_end(); ++row) {
            for (int col = part.col; col < part.col_end(); ++col) {
                differing += a.at(row, col) != left(row, col);
                differing += b.at(row, col) != right(row, col);
                differing += c.at(row, col) != truth_left(row, col);
                differing += d.at(row, col) != truth_right(row, col);
                differing += e.at(row, col) != visible_left(row, col);
                differing += f.at(row, col) != visible_right(row, col);
            }
        }
        CHECK(differing == 0);
    }
}

TEST_CASE("a part that reaches outside the image is refused")
{
    const Renderer r(plane(0));
    tiling::Image<float> out({2, 2});
    CHECK_THROWS_AS(r.truth_left({39, 0, 2, 2}, out), std::invalid_argument);
    CHECK_THROWS_AS(r.truth_left({0, 0, 3, 2}, out), std::invalid_argument);
}

TEST_CASE("the images of a level plane are shifted copies")
{
    const Renderer r(plane(7));
    const auto left = image(r, View::left);
    const auto right = image(r, View::right);
    for (int row = 0; row < 40; ++row) {
        for (int col = 7; col < 60; ++col) {
            REQUIRE(left(row, col) == right(row, col - 7));
        }
    }
}

TEST_CASE("the truth of a tilted plane has its closed form in both views")
{
    const Renderer r(plane(5, 0.2, -0.1));
    const auto left = truth(r, View::left);
    const auto right = truth(r, View::right);
    for (int row = 0; row < 40; row += 13) {
        for (int col = 0; col < 60; col += 7) {
            CHECK(left(row, col) == Approx(5 + 0.2 * col - 0.1 * row));
            CHECK(right(row, col) == Approx((5 + 0.2 * col - 0.1 * row) / 0.8));
        }
    }
}

TEST_CASE("a block hides the strip of ground that is as wide as its height")
{
    Scene scene = plane(2);
    scene.objects = {{Shape::rectangle, 30, 20, 10, 10, 0, 6, Roof::flat, 0, {}}};
    const Renderer r(scene);
    const auto left = truth(r, View::left);
    const auto right = truth(r, View::right);
    const auto seen = visible(r, View::left);
    // The roof covers x in [25, 35) at d = 8: columns 17 to 26 of the right image, where the
    // ground's columns 19 to 28 would be. Left of the roof 19 to 24 are hidden.
    for (int col = 0; col < 60; ++col) {
        CAPTURE(col);
        CHECK(left(20, col) == (col >= 25 && col < 35 ? 8 : 2));
        CHECK(right(20, col) == (col >= 17 && col < 27 ? 8 : 2));
        CHECK(bool(seen(20, col)) == !((col >= 19 && col < 25) || col < 2));
    }
    CHECK(left(14, 30) == 2);
    CHECK(left(15, 30) == 8);
}

TEST_CASE("an object's edge pixel is mixed by its share")
{
    Scene scene = plane(0);
    scene.terrain.texture = {0.2, 0, 2.5, 1};
    scene.objects = {
        {Shape::rectangle, 20.25, 20, 10, 10, 0, 3, Roof::flat, 0, {0.8, 0, 2.5, 1}}};
    const Renderer r(scene);
    const auto left = image(r, View::left);
    const auto right = image(r, View::right);
    // The roof begins at x = 15.25: a quarter of pixel 15, which is [14.5, 15.5).
    CHECK(left(20, 14) == 51);
    CHECK(left(20, 15) == std::floor(255 * (0.75 * 0.2 + 0.25 * 0.8) + 0.5));
    CHECK(left(20, 16) == 204);
    CHECK(right(20, 12) == left(20, 15));
}

TEST_CASE("a gable's two sides rise to the ridge")
{
    Scene scene = plane(1);
    scene.objects = {{Shape::rectangle, 30, 20, 20, 10, 0, 4, Roof::gable, 2, {}}};
    const auto left = truth(Renderer(scene), View::left);
    CHECK(left(20, 30) == Approx(1 + 4 + 2));
    CHECK(left(17, 30) == Approx(1 + 4 + 2 - 3 * 0.4));
    CHECK(left(23, 30) == Approx(1 + 4 + 2 - 3 * 0.4));
    CHECK(left(26, 30) == 1);
}

TEST_CASE("a view's disparity bounds hold everywhere")
{
    for (const Scene& scene : {small_city(), plane(5, 0.4, 0.1), plane(-50, -0.4, 1)}) {
        const Renderer r(scene);
        const DisparityBounds bounds = r.disparity_bounds();
        for (const View view : {View::left, View::right}) {
            const auto d = truth(r, view);
            for (const float v : d.pixels()) {
                REQUIRE(v >= bounds.min_px - 1e-4);
                REQUIRE(v <= bounds.max_px + 1e-4);
            }
        }
    }
}

TEST_CASE("the right image warped by the truth is the left image")
{
    Scene scene = small_city();
    scene.left = {};
    scene.right = {};
    const Renderer r(scene);
    const auto left = image(r, View::left);
    const auto right = image(r, View::right);
    const auto d = truth(r, View::left);
    const auto seen = visible(r, View::left);
    double with_truth = 0;
    double one_px_off = 0;
    int pixels = 0;
    for (int row = 0; row < scene.size.rows; ++row) {
        for (int col = 60; col + 2 < scene.size.cols; ++col) {
            const double x = col - double{d(row, col)};
            const int x0 = static_cast<int>(std::floor(x));
            if (!seen(row, col) || x0 < 0 || x0 + 2 >= scene.size.cols) {
                continue;
            }
            const auto right_at = [&](int first) {
                return right(row, first) +
                       (x - x0) * (right(row, first + 1) - right(row, first));
            };
            with_truth += std::abs(left(row, col) - right_at(x0));
            one_px_off += std::abs(left(row, col) - right_at(x0 + 1));
            ++pixels;
        }
    }
    CHECK(pixels > 70000);
    // What is left with truth comes from linear interpolation and from mixed edge pixels.
    CHECK(with_truth / one_px_off < 0.35);
}
