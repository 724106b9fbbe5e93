#include "tests/catch.h"

#include "pipeline/synth/row_view.h"
#include "tests/unit/synth/scenes.h"

using namespace hsgm;
using namespace hsgm::synth;
using namespace hsgm::synth::testing;

namespace {

Scene without_nodata(Scene scene)
{
    scene.right.nodata_border_px = 0;
    scene.right.holes.clear();
    return scene;
}

} // namespace

TEST_CASE("occluded pixels are exactly those whose right point shows something nearer")
{
    const Scene scene = without_nodata(small_city());
    const Renderer r(scene);
    const auto seen = visible(r, View::left);
    const Landscape landscape(scene);
    // Every piece of the scene, and a margin: no choice by place that could be wrong.
    const auto pieces = landscape.pieces_over({-200, 900, -200, 350});
    int occluded = 0;
    for (int row = 0; row < scene.size.rows; row += 5) {
        const RowView left(landscape, pieces, View::left, row);
        const RowView right(landscape, pieces, View::right, row);
        for (int col = 0; col < scene.size.cols; ++col) {
            const double d = left.nearest(col).disparity_px;
            const double x_right = col - d;
            const double there = right.nearest(x_right).disparity_px;
            const bool in_frame = x_right >= -0.5 && x_right < scene.size.cols - 0.5;
            occluded += in_frame && there > d + 1e-6;
            REQUIRE(there >= d - 1e-6);
            REQUIRE(bool(seen(row, col)) == (in_frame && there <= d + 1e-6));
        }
    }
    CHECK(occluded > 1000);
}

TEST_CASE("what the left image sees of the right agrees with what the right sees of it")
{
    const Scene scene = without_nodata(small_city());
    const Renderer r(scene);
    const auto seen = visible(r, View::right);
    const auto truth_right = truth(r, View::right);
    const Landscape landscape(scene);
    const auto pieces = landscape.pieces_over({-200, 900, -200, 350});
    for (int row = 0; row < scene.size.rows; row += 7) {
        const RowView left(landscape, pieces, View::left, row);
        for (int col = 0; col < scene.size.cols; ++col) {
            if (seen(row, col)) {
                const double d = truth_right(row, col);
                REQUIRE(left.nearest(col + d).disparity_px == Approx(d).margin(1e-3));
            }
        }
    }
}

TEST_CASE("a point without data in the right image is not visible")
{
    Scene scene = plane(3);
    scene.right.nodata_border_px = 4;
    scene.right.holes = {{20, 20, 2}};
    const Renderer r(scene);
    const auto right = image(r, View::right);
    const auto seen = visible(r, View::left);
    CHECK(right(3, 30) == 0);
    CHECK(right(20, 21) == 0);
    CHECK(right(20, 23) > 0);
    CHECK(seen(20, 24) == 0);
    CHECK(seen(20, 26) == 255);
    CHECK(seen(3, 30) == 0);
}
