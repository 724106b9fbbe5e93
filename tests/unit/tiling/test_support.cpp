#include "tests/catch.h"

#include "tiling/pyramid.h"
#include "tiling/support.h"

#include <random>

using namespace hsgm::tiling;

namespace {

struct Setting {
    Size left{300, 410};
    Size right{300, 380};
    DisparityRange asked{-21, 75};
    int levels = 3;
    SupportRule rule;

    std::vector<LevelSupport> of(const Rect& core) const
    {
        return tile_support(core, pyramid_sizes(left, levels), pyramid_sizes(right, levels),
                            pyramid_ranges(asked, levels), rule);
    }
};

Rect random_core(std::mt19937& random, Size image)
{
    const auto below = [&random](int n) { return static_cast<int>(random() % unsigned(n)); };
    return intersect({below(image.rows), below(image.cols), 1 + below(90), 1 + below(90)},
                     rect_of(image));
}

} // namespace

TEST_CASE("a larger core has a larger support on every level")
{
    std::mt19937 random(3);
    for (const int halo : {0, 8, 20}) {
        for (const int step : {1, 2}) {
            Setting setting;
            setting.rule.halo_px = halo;
            setting.rule.path_step_px = step;
            setting.levels = 4;
            for (int i = 0; i < 40; ++i) {
                const Rect small = random_core(random, setting.left);
                const Rect large = unite(small, random_core(random, setting.left));
                const auto less = setting.of(small);
                const auto more = setting.of(large);
                for (std::size_t k = 0; k < less.size(); ++k) {
                    CHECK(more[k].windows.contains(less[k].windows));
                    CHECK(more[k].aggregation.contains(less[k].aggregation));
                    CHECK(more[k].left_image.contains(less[k].left_image));
                    CHECK(more[k].right_image.contains(less[k].right_image));
                }
            }
        }
    }
}

TEST_CASE("the support of a tile in the middle can be followed by hand")
{
    Setting setting;
    setting.left = setting.right = {2000, 2000};
    setting.asked = {0, 63};
    const auto support = setting.of({1000, 1100, 50, 10});
    REQUIRE(support.size() == 3);
    // Rows 1000..1049 lie in windows 15 and 16, columns 1100..1109 in window 17.
    CHECK(support[0].windows == rect_between(960, 1088, 1088, 1152));
    CHECK(support[0].aggregation == rect_between(952, 1080, 1096, 1160));
    CHECK(support[0].left_image == rect_between(949, 1077, 1099, 1163));
    CHECK(support[0].right_image == rect_between(949, 1077 - 63, 1099, 1163));
    // Paths start at 951 and 1096, columns 1079 and 1160; halved: 475..548, 539..580. Their
    // windows: rows 448..576, columns 512..640.
    CHECK(support[1].windows == rect_between(448, 512, 576, 640));
    CHECK(support[1].left_image == rect_between(437, 501, 587, 651));
    CHECK(support[1].right_image == rect_between(437, 501 - 31, 587, 651));
    // The coarsest is whole: its results are read at 439 / 2 .. 584 / 2 and 503 / 2 .. 648 / 2.
    CHECK(support[2].windows == rect_between(219, 251, 293, 325));
    CHECK(support[2].left_image.empty());
    CHECK(support[2].right_image.empty());
}

TEST_CASE("a support is clipped to the images")
{
    Setting setting;
    const auto support = setting.of({0, 0, setting.left.rows, setting.left.cols});
    const auto left = pyramid_sizes(setting.left, setting.levels);
    const auto right = pyramid_sizes(setting.right, setting.levels);
    for (std::size_t k = 0; k < 2; ++k) {
        CHECK(support[k].windows == rect_of(left[k]));
        CHECK(support[k].aggregation == rect_of(left[k]));
        CHECK(support[k].left_image == rect_of(left[k]));
        CHECK(support[k].right_image == rect_of(right[k]));
    }
}

TEST_CASE("looking for ranges reaches further than paths where there is no halo")
{
    Setting setting;
    setting.left = setting.right = {2000, 2000};
    setting.rule.halo_px = 0;
    setting.rule.window_px = 16;
    setting.levels = 2;
    const Rect core{512, 512, 16, 16}; // halved: 256..263; paths start at 255 and 264
    setting.rule.range_look_px = 0;
    CHECK(setting.of(core)[1].windows == rect_between(255, 255, 265, 265));
    setting.rule.range_look_px = 2;
    CHECK(setting.of(core)[1].windows == rect_between(254, 254, 266, 266));
}

TEST_CASE("without a whole level every level has windows")
{
    Setting setting;
    setting.levels = 1;
    setting.rule.coarsest_whole = false;
    const auto support = setting.of({10, 10, 5, 5});
    REQUIRE(support.size() == 1);
    CHECK(support[0].windows == Rect{0, 0, 64, 64});
    CHECK_FALSE(support[0].left_image.empty());
    setting.rule.coarsest_whole = true;
    CHECK(setting.of({10, 10, 5, 5})[0].windows == Rect{10, 10, 5, 5});
}

TEST_CASE("a range that never meets the right image needs none of it")
{
    Setting setting;
    setting.asked = {300, 330};
    const auto support = setting.of({0, 0, 64, 64});
    CHECK(support[0].right_image.empty());
    CHECK_FALSE(support[0].left_image.empty());
}
