#include "tests/catch.h"

#include "tests/cuda/many_cases.h"
#include "tests/reference/themes.h"

using namespace hsgm;
using namespace hsgm::reference;
using cuda_test::compare_with_device;

TEST_CASE("device and host agree on tiny images")
{
    compare_with_device(tiny(), 2'100'000, 400);
}

TEST_CASE("device and host agree on small images, whatever the options")
{
    compare_with_device(small(), 2'200'000, 300);
}

TEST_CASE("device and host agree on thin images")
{
    compare_with_device(thin(), 2'250'000, 200);
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
    compare_with_device(dear(), 2'500'000, 150);
}

TEST_CASE("device and host agree on windows of mode hsgm")
{
    compare_with_device(of_mode(Mode::hsgm), 2'600'000, 60);
}

TEST_CASE("device and host agree on mode hsgm-paper")
{
    compare_with_device(of_mode(Mode::hsgm_paper), 2'700'000, 50);
}

TEST_CASE("device and host agree on mode local")
{
    compare_with_device(of_mode(Mode::local), 2'800'000, 50);
}
