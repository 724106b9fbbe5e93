#include "tests/catch.h"

#include "io/config.h"
#include "io/error.h"
#include "matcher/profile.h"
#include "pipeline/configuration.h"

#include <string>

using namespace hsgm;

namespace {

pipeline::Configuration configured(const std::string& matcher)
{
    auto document = io::ConfigDocument::parse("pair: {left: left.tif, right: right.tif}\n"
                                              "geometry: {kind: rectified}\n"
                                              "output: {folder: result}\n"
                                              "matcher: {disparity: [0, 63]" +
                                                  matcher + "}\n",
                                              "run.yaml");
    return pipeline::read_configuration(document);
}

} // namespace

TEST_CASE("a profile gives the keys that are left out")
{
    CHECK(configured("").job.matcher == options_of(matcher::Profile::satellite));
    CHECK(configured(", profile: aerial").job.matcher == options_of(matcher::Profile::aerial));
    CHECK(configured(", profile: close").job.matcher == options_of(matcher::Profile::close));
}

TEST_CASE("a key that is given wins over its profile")
{
    const matcher::Options o =
        configured(", p1: 30, cost: census9x7, profile: close").job.matcher;
    matcher::Options expected = options_of(matcher::Profile::close);
    expected.p1 = 30;
    expected.cost = matcher::Cost::census9x7;
    CHECK(o == expected);
}

TEST_CASE("the used configuration names the profile and what it chose, and repeats the run")
{
    const auto first = configured(", profile: close");
    CHECK_THAT(first.used_yaml, Catch::Matchers::Contains("profile: close") &&
                                    Catch::Matchers::Contains("cost: pairs_bt") &&
                                    Catch::Matchers::Contains("p1: 20"));
    auto again = io::ConfigDocument::parse(first.used_yaml, "config.used.yaml");
    CHECK(pipeline::read_configuration(again).job.matcher == first.job.matcher);
}
