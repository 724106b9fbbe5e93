#include "tests/catch.h"

#include "tests/cuda/many_cases.h"
#include "tests/reference/themes.h"

#include <utility>

using namespace hsgm;
using namespace hsgm::reference;

TEST_CASE("device and host agree on thousands of cases")
{
    const std::pair<Theme, int> themes[] = {
        {tiny(), 3'000},
        {small(), 1'500},
        {thin(), 1'500},
        {pruned(), 150},
        {wide_ranges(), 300},
        {dear(), 600},
        {of_mode(Mode::hsgm), 300},
        {of_mode(Mode::hsgm_paper), 200},
        {of_mode(Mode::local), 200},
    };
    std::uint64_t first = 20'000'000;
    for (const auto& [theme, cases] : themes) {
        cuda_test::compare_with_device(theme, first, cases);
        first += 1'000'000;
    }
}

TEST_CASE("device and host agree on every cost, with every number of paths and width")
{
    std::uint64_t first = 30'000'000;
    for (const Cost cost : matcher::all_costs()) {
        for (const int paths : {4, 5, 8, 16}) {
            for (const bool wide : {false, true}) {
                cuda_test::compare_with_device(of_cost(cost, paths, wide), first, 12);
                first += 1'000;
            }
        }
    }
}
