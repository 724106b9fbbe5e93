#include "tests/catch.h"

#include "matcher/instructions.h"
#include "matcher/matcher.h"

#include <algorithm>
#include <string>

using namespace hsgm::matcher;
using Catch::Matchers::Contains;

namespace {

// How Highway names what a restriction to `set` leaves.
std::string expected(Instructions set)
{
    return set == Instructions::sse4 ? "SSE4" : set == Instructions::avx2 ? "AVX2" : "AVX3";
}

bool is_usable(Instructions set)
{
    const auto usable = usable_instructions();
    return std::find(usable.begin(), usable.end(), set) != usable.end();
}

} // namespace

TEST_CASE("sets of instructions are found by their names")
{
    for (const Instructions set :
         {Instructions::sse4, Instructions::avx2, Instructions::avx512}) {
        CHECK(instructions_from_name(name(set)) == set);
    }
    CHECK_THROWS_WITH(instructions_from_name("AVX2"),
                      "instructions must be one of avx512, avx2, sse4, not 'AVX2'");
}

TEST_CASE("the matcher keeps to the instructions that it is given, until it is free again")
{
    const std::string best = vector_instructions();
    const auto usable = usable_instructions();
    REQUIRE_FALSE(usable.empty()); // Highway alone asks for more than SSE 4
    CHECK(best == expected(usable.front()));
    for (const Instructions set : usable) {
        use_instructions(set);
        CHECK(vector_instructions() == expected(set));
        CHECK(usable_instructions() == usable);
        CHECK(vector_instructions() == expected(set));
    }
    use_instructions(std::nullopt);
    CHECK(vector_instructions() == best);
}

TEST_CASE("instructions that the processor lacks are refused, and nothing changes")
{
    use_instructions(std::nullopt);
    const std::string best = vector_instructions();
    for (const Instructions set :
         {Instructions::sse4, Instructions::avx2, Instructions::avx512}) {
        if (is_usable(set)) {
            CHECK_NOTHROW(use_instructions(set));
            use_instructions(std::nullopt);
        } else {
            CHECK_THROWS_WITH(use_instructions(set), Contains("this processor has no"));
        }
        CHECK(vector_instructions() == best);
    }
}
