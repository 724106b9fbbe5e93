#include "tests/catch.h"

#include "matcher/options.h"

#include <functional>
#include <string>

using namespace hsgm::matcher;

namespace {

std::string refusal(const std::function<void(Options&)>& change)
{
    Options options;
    change(options);
    try {
        options.validate();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "accepted";
}

} // namespace

TEST_CASE("the default options are valid")
{
    CHECK_NOTHROW(Options{}.validate());
    CHECK(Options{} == Options{}.resolved());
}

TEST_CASE("each option outside its bounds is named, with its value and what is allowed")
{
    CHECK(refusal([](Options& o) { o.paths = 6; }) == "paths must be 4, 5, 8 or 16, not 6");
    CHECK(refusal([](Options& o) { o.levels = -1; }) == "levels must be auto or 1..12, not -1");
    CHECK(refusal([](Options& o) { o.levels = 13; }) == "levels must be auto or 1..12, not 13");
    CHECK(refusal([](Options& o) { o.window_px = 40; }) ==
          "window must be a multiple of 16 from 16 to 1024, not 40");
    CHECK(refusal([](Options& o) { o.window_px = 0; }) ==
          "window must be a multiple of 16 from 16 to 1024, not 0");
    CHECK(refusal([](Options& o) { o.halo_px = 7; }) ==
          "halo must be an even number from 0 to the window size, not 7");
    CHECK(refusal([](Options& o) { o.halo_px = 66; }) ==
          "halo must be an even number from 0 to the window size, not 66");
    CHECK(refusal([](Options& o) { o.p2 = 4001; }) == "p2 must be 0..4000, not 4001");
    CHECK(refusal([](Options& o) { o.p1 = 200; }) == "p1 must be 0..p2, not 200");
    CHECK(refusal([](Options& o) { o.p2_half_tone = 0; }) ==
          "p2_half_tone must be 1..255, not 0");
    CHECK(refusal([](Options& o) { o.left_right_px = -2; }) ==
          "left_right_px must be off or 0..64, not -2");
    CHECK(refusal([](Options& o) { o.median = 4; }) == "median must be 1 (off), 3 or 5, not 4");
    CHECK(refusal([](Options& o) { o.speckle_px = 1; }) ==
          "speckle_px must be off or 2..500, not 1");
    CHECK(refusal([](Options& o) { o.speckle_px = 501; }) ==
          "speckle_px must be off or 2..500, not 501");
    CHECK(refusal([](Options& o) { o.speckle_range_px = 0; }) ==
          "speckle_range_px must be 1..64, not 0");
    CHECK(refusal([](Options& o) { o.min_confidence = 256; }) ==
          "min_confidence must be 0..255, not 256");
    CHECK(refusal([](Options& o) { o.fill_px = 0; }) == "fill_px must be 1..256, not 0");
    CHECK(refusal([](Options& o) { o.smooth = 7; }) == "smooth must be 1 (off), 3 or 5, not 7");
}

TEST_CASE("the ends of what is allowed are allowed")
{
    for (const int paths : {4, 5, 8, 16}) {
        CHECK(refusal([=](Options& o) { o.paths = paths; }) == "accepted");
    }
    CHECK(refusal([](Options& o) { o.window_px = o.halo_px = 16; }) == "accepted");
    CHECK(refusal([](Options& o) { o.window_px = 1024; }) == "accepted");
    CHECK(refusal([](Options& o) { o.p1 = o.p2 = 4000; }) == "accepted");
    CHECK(refusal([](Options& o) { o.p1 = o.p2 = 0; }) == "accepted");
    CHECK(refusal([](Options& o) { o.left_right_px = -1; }) == "accepted");
    CHECK(refusal([](Options& o) { o.levels = 12; }) == "accepted");
    CHECK(refusal([](Options& o) { o.speckle_px = 0; }) == "accepted");
    CHECK(refusal([](Options& o) { o.speckle_px = 500; }) == "accepted");
    CHECK(refusal([](Options& o) { o.min_confidence = 255; }) == "accepted");
}

TEST_CASE("a mode puts its own in place of what it has no use for")
{
    Options options;
    options.levels = 5;
    options.mode = Mode::hsgm_paper;
    CHECK(options.resolved().halo_px == 0);
    CHECK(options.resolved().levels == 5);
    CHECK_FALSE(options.resolved().prior);
    CHECK_FALSE(options.resolved().prune);
    for (const Mode mode : {Mode::sgm, Mode::local}) {
        options.mode = mode;
        CHECK(options.resolved().levels == 1);
        CHECK(options.resolved().halo_px == 8);
        CHECK_FALSE(options.resolved().prior);
        CHECK_FALSE(options.resolved().prune);
    }
}

TEST_CASE("modes and costs are found by their names")
{
    for (const Mode mode : {Mode::hsgm, Mode::hsgm_paper, Mode::sgm, Mode::local}) {
        CHECK(mode_from_name(name(mode)) == mode);
    }
    CHECK(all_costs().size() >= 9);
    for (const Cost cost : all_costs()) {
        CHECK(cost_from_name(name(cost)) == cost);
    }
    for (const Subpixel subpixel : {Subpixel::census, Subpixel::sums}) {
        CHECK(subpixel_from_name(name(subpixel)) == subpixel);
    }
    for (const Fill fill : {Fill::none, Fill::occluded, Fill::all}) {
        CHECK(fill_from_name(name(fill)) == fill);
    }
    CHECK_THROWS_WITH(fill_from_name("some"),
                      "fill must be one of none, occluded, all, not 'some'");
    CHECK_THROWS_WITH(mode_from_name("SGM"),
                      "mode must be one of hsgm, hsgm-paper, sgm, local, not 'SGM'");
    CHECK_THROWS_WITH(cost_from_name("census"),
                      Catch::Matchers::Contains("census5x5, census7x7, census9x7, pairs5x5, "
                                                "ternary5x5, census_ad, pairs_bt, "
                                                "birchfield_tomasi, hmi"));
}
