#include "tests/catch.h"

#include "tests/cuda/comparison.h"
#include "tests/reference/themes.h"

#include <cstdlib>

using namespace hsgm;
using namespace hsgm::reference;

namespace {

// Sanitizers are slow; they look for other things, and in few cases as well as in many.
#if defined(__SANITIZE_THREAD__)
constexpr int kShare = 40;
#elif defined(__SANITIZE_ADDRESS__)
constexpr int kShare = 10;
#else
constexpr int kShare = 1;
#endif

void compare_with_device(const Theme& theme, std::uint64_t first, int cases)
{
    cases = std::max(1, cases / kShare);
    if (const char* count = std::getenv("HSGM_REFERENCE_CASES")) {
        cases = std::atoi(count);
    }
    if (const char* seed = std::getenv("HSGM_REFERENCE_SEED")) {
        first = std::strtoull(seed, nullptr, 10);
        cases = 1;
    }
    int matched = 0;
    for (int i = 0; i < cases; ++i) {
        const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
        const Case c = random_case(seed, theme);
        const auto setting = cuda_test::setting_number(seed);
        const auto outcome = cuda_test::compare_tiles(c, setting);
        INFO(c.describe() << "\n"
                          << stand_in::text(setting.schedule) << ", " << setting.block_threads
                          << " threads, " << setting.shared_bytes << " bytes of shared memory");
        CHECK(outcome.difference == "");
        matched += outcome.refused ? 0 : 1;
    }
    CHECK(matched > 0);
}

} // namespace

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
