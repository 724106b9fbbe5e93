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
