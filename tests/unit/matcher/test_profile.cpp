#include "tests/catch.h"

#include "matcher/profile.h"

using namespace hsgm::matcher;

TEST_CASE("the default options are those of profile satellite")
{
    CHECK(options_of(Profile::satellite) == Options{});
}

TEST_CASE("every profile is valid, fits 8 bits, and is found by its name")
{
    for (const Profile profile : {Profile::satellite, Profile::aerial, Profile::close}) {
        CAPTURE(name(profile));
        CHECK_NOTHROW(options_of(profile).validate());
        CHECK(options_of(profile).fits_8_bits());
        CHECK(profile_from_name(name(profile)) == profile);
    }
    CHECK_FALSE(options_of(Profile::aerial) == Options{});
    CHECK_FALSE(options_of(Profile::close) == options_of(Profile::aerial));
    CHECK_THROWS_WITH(profile_from_name("city"),
                      "profile must be one of satellite, aerial, close, not 'city'");
}

TEST_CASE("penalties fit how alike the images are")
{
    const auto fitted = [](double unlike_share) {
        Options options;
        fit_penalties(options, unlike_share);
        return options;
    };
    const Options asked;
    // All alike: a half and a quarter. A fifth unlike, or more: as they are.
    CHECK(fitted(0).p1 == asked.p1 / 2);
    CHECK(fitted(0).p2 == asked.p2 / 4);
    CHECK(fitted(0.05) == fitted(0));
    CHECK(fitted(0.2) == asked);
    CHECK(fitted(1) == asked);
    CHECK(fitted(0.125).p1 == 18); // half-way
    CHECK(fitted(0.125).p2 == 120);
    for (double share = 0.05; share < 0.2; share += 0.01) {
        CAPTURE(share);
        CHECK(fitted(share).p1 <= fitted(share + 0.01).p1);
        CHECK(fitted(share).p2 < fitted(share + 0.01).p2);
        CHECK_NOTHROW(fitted(share).validate());
    }
}

TEST_CASE("fitted penalties stay possible, and those of mode hsgm-paper as they are")
{
    Options equal;
    equal.p1 = equal.p2 = 40;
    fit_penalties(equal, 0);
    CHECK(equal.p1 == 20);
    CHECK(equal.p2 == 20); // never below p1
    Options paper;
    paper.mode = Mode::hsgm_paper;
    const Options before = paper;
    fit_penalties(paper, 0);
    CHECK(paper == before);
}
