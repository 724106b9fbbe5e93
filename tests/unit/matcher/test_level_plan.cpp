#include "tests/catch.h"

#include "matcher/level_plan.h"
#include "matcher/matcher.h"
#include "matcher/reasons.h"

#include <limits>
#include <stdexcept>

using namespace hsgm;
using namespace hsgm::matcher;

namespace {

PairShape shape_of(int rows, int left_cols, int right_cols, int least, int most)
{
    return {{rows, left_cols}, {rows, right_cols}, {least, most}};
}

int levels_of(const PairShape& shape, const Options& options = {})
{
    return plan_levels(shape, options).levels();
}

Options with_mode(Mode mode)
{
    Options options;
    options.mode = mode;
    return options;
}

} // namespace

TEST_CASE("an archive image has as many levels as bring its coarsest to 32 Mi cells")
{
    CHECK(levels_of(shape_of(40'000, 40'000, 40'000, 0, 511)) == 6);
    CHECK(levels_of(shape_of(40'000, 40'000, 40'000, -256, 255)) == 6);
    CHECK(levels_of(shape_of(1024, 1024, 1024, 0, 63)) == 3);
    // 2048 x 2048 x 512 is 2^31 cells and each level an eighth: 3 levels leave 2^25.
    CHECK(levels_of(shape_of(2048, 2048, 2048, 0, 511)) == 3);
    CHECK(levels_of(shape_of(2050, 2048, 2048, 0, 511)) == 4);
}

TEST_CASE("no level has a side below 32 px unless it was asked for")
{
    CHECK(levels_of(shape_of(125, 500, 500, 0, 15)) == 3); // 125, 63, 32
    CHECK(levels_of(shape_of(124, 500, 500, 0, 15)) == 2); // 124, 62, 31
    CHECK(levels_of(shape_of(500, 500, 62, 0, 15)) == 1);
    CHECK(levels_of(shape_of(1, 1, 1, 0, 0)) == 1);
    Options options;
    options.levels = 4;
    CHECK(levels_of(shape_of(20, 20, 20, 0, 15), options) == 4);
}

TEST_CASE("each mode has the levels it needs")
{
    const PairShape large = shape_of(40'000, 40'000, 40'000, 0, 511);
    CHECK(levels_of(large, with_mode(Mode::hsgm_paper)) == 3);
    CHECK(levels_of(large, with_mode(Mode::sgm)) == 1);
    CHECK(levels_of(large, with_mode(Mode::local)) == 1);
    CHECK(plan_levels(large, with_mode(Mode::sgm)).windowed_levels() == 0);
    CHECK(plan_levels(large, with_mode(Mode::local)).windowed_levels() == 1);
    CHECK(plan_levels(large, Options{}).windowed_levels() == 5);
    CHECK(hmi_level(large) == 5);
}

TEST_CASE("the plan does not depend on anything but pair and options")
{
    Options options;
    options.left_right_px = 5;
    options.median = 5;
    const PairShape shape = shape_of(600, 700, 650, -20, 90);
    CHECK(plan_levels(shape, options).ranges == plan_levels(shape, Options{}).ranges);
    CHECK(plan_levels(shape, options).right_sizes == plan_levels(shape, Options{}).right_sizes);
}

TEST_CASE("pairs that cannot be matched are refused with numbers")
{
    using Catch::Matchers::Contains;
    const Options options;
    CHECK_THROWS_WITH(plan_levels({{10, 20}, {11, 20}, {0, 5}}, options),
                      Contains("20 x 10 px") && Contains("20 x 11 px"));
    CHECK_THROWS_WITH(plan_levels(shape_of(10, 20, 20, 6, 5), options),
                      Contains("6..5 is reversed"));
    CHECK_THROWS_WITH(plan_levels(shape_of(0, 20, 20, 0, 5), options), Contains("1 x 1"));
    CHECK_THROWS_WITH(plan_levels(shape_of(10, 20, 30, 20, 25), options),
                      Contains("20..25") && Contains("allow -29..19"));
    CHECK_THROWS_WITH(plan_levels(shape_of(10, 20, 30, -40, -30), options),
                      Contains("allow -29..19"));
    CHECK_THROWS_WITH(plan_levels(shape_of(10, 20, 20, 0, 20'000), options),
                      Contains("-16000..16000"));
    constexpr int kHuge = std::numeric_limits<int>::max();
    CHECK_THROWS_WITH(plan_levels(shape_of(10, 20, 20, -5, kHuge - 6), options),
                      Contains("-16000..16000"));
    // The last disparities for which one pixel has a counterpart.
    CHECK_NOTHROW(plan_levels(shape_of(10, 20, 30, 19, 25), options));
    CHECK_NOTHROW(plan_levels(shape_of(10, 20, 30, -40, -29), options));
}

TEST_CASE("the reach of a match follows from its options")
{
    Options options;
    CHECK(support_rule(options).image_radius_cols == 3);
    CHECK(support_rule(options).range_look_px == 2);
    CHECK(support_rule(options).path_step_px == 1);
    options.cost = Cost::census9x7;
    options.paths = 16;
    options.prune = false;
    CHECK(support_rule(options).image_radius_cols == 4);
    CHECK(support_rule(options).image_radius_rows == 3);
    CHECK(support_rule(options).range_look_px == 0);
    CHECK(support_rule(options).path_step_px == 2);
    options.cost = Cost::hmi; // the texture gate still looks round
    CHECK(support_rule(options).image_radius_rows == 3);
    CHECK_FALSE(support_rule(with_mode(Mode::local)).coarsest_whole);
}

TEST_CASE("every reason has a bit of its own and the first byte takes the value away")
{
    unsigned all = 0;
    for (const auto& [bit, text] : kReasonNames) {
        CHECK((all & bit) == 0);
        CHECK((bit & (bit - 1)) == 0);
        CHECK_FALSE(text.empty());
        all |= bit;
    }
    CHECK((kOutside & kInvalidating) != 0);
    CHECK((kInconsistent & kInvalidating) != 0);
    CHECK((kLowTexture & kInvalidating) == 0);
    CHECK((kRangeEnd & kInvalidating) == 0);
}
