#include "tests/catch.h"

#include "matcher/profile.h"
#include "tests/cuda/many_cases.h"
#include "tests/reference/themes.h"

using namespace hsgm;
using namespace hsgm::reference;
using cuda_test::compare_with_device;

TEST_CASE("device and host agree on tiny images")
{
    compare_with_device(tiny(), 2'100'000, 300);
}

TEST_CASE("device and host agree on small images, whatever the options")
{
    compare_with_device(small(), 2'200'000, 220);
}

TEST_CASE("device and host agree on thin images")
{
    compare_with_device(thin(), 2'250'000, 150);
}

TEST_CASE("device and host agree where ranges are pruned")
{
    compare_with_device(pruned(), 2'300'000, 20);
}

TEST_CASE("device and host agree on ranges wider than the images")
{
    compare_with_device(wide_ranges(), 2'400'000, 40);
}

TEST_CASE("device and host agree on penalties beyond eight bits")
{
    compare_with_device(dear(), 2'500'000, 110);
}

TEST_CASE("device and host agree on windows of mode hsgm")
{
    compare_with_device(of_mode(Mode::hsgm), 2'600'000, 45);
}

TEST_CASE("device and host agree on mode hsgm-paper")
{
    compare_with_device(of_mode(Mode::hsgm_paper), 2'700'000, 40);
}

TEST_CASE("device and host agree on mode local")
{
    compare_with_device(of_mode(Mode::local), 2'800'000, 50);
}

TEST_CASE("device and host agree on every cost")
{
    std::uint64_t first = 2'900'000;
    for (const Cost cost : matcher::all_costs()) {
        for (const int paths : {4, 8}) {
            compare_with_device(of_cost(cost, paths, false), first, 8);
            first += 1'000;
        }
    }
}

TEST_CASE("device and host agree on every profile")
{
    std::uint64_t first = 2'950'000;
    for (const auto profile :
         {matcher::Profile::satellite, matcher::Profile::aerial, matcher::Profile::close}) {
        Theme theme;
        theme.most_side_px = 80;
        theme.most_count = 60;
        theme.most_work = 400'000;
        theme.vary = [profile](Random& random, Options& o) {
            o = matcher::options_of(profile);
            o.levels = random.between(2, 3);
            o.window_px = random.one_of({16, 32, 64});
        };
        compare_with_device(theme, first, 3);
        first += 1'000;
    }
}
