#include "tests/catch.h"

#include "tests/reference/themes.h"

#include <utility>

using namespace hsgm::reference;

TEST_CASE("matcher and twin agree on many thousands of cases")
{
    const std::pair<Theme, int> themes[] = {
        {tiny(), 20'000},
        {small(), 8'000},
        {thin(), 8'000},
        {pruned(), 1'000},
        {wide_ranges(), 2'000},
        {dear(), 4'000},
        {of_mode(Mode::hsgm), 2'000},
        {defaults(), 200},
        {of_mode(Mode::hsgm_paper), 1'000},
        {of_mode(Mode::sgm), 1'000},
        {of_mode(Mode::local), 1'000},
    };
    std::uint64_t first = 10'000'000;
    for (const auto& [theme, cases] : themes) {
        compare(theme, first, cases);
        first += 1'000'000;
    }
}
