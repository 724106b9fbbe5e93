#include "tests/cuda/many_cases.h"

#include "tests/catch.h"

#include "tests/cuda/comparison.h"

#include <algorithm>
#include <cstdlib>

namespace hsgm::cuda_test {

using reference::Case;
using reference::Theme;

namespace {

// Sanitizers are slow; they look for other things, and in few cases as well as in many.
#if defined(__SANITIZE_THREAD__)
constexpr int kShare = 40;
#elif defined(__SANITIZE_ADDRESS__)
constexpr int kShare = 10;
#else
constexpr int kShare = 1;
#endif

// A case without windows is the processor's, and not counted; most have some.
constexpr int kMostTries = 20;

} // namespace

void compare_with_device(const Theme& theme, std::uint64_t first, int cases)
{
    cases = std::max(1, cases / kShare);
    int most_tries = kMostTries * cases;
    if (const char* count = std::getenv("HSGM_REFERENCE_CASES")) {
        cases = std::atoi(count);
        most_tries = kMostTries * cases;
    }
    if (const char* seed = std::getenv("HSGM_REFERENCE_SEED")) {
        first = std::strtoull(seed, nullptr, 10);
        cases = 1;
        most_tries = 1;
    }
    int matched = 0;
    for (int i = 0; matched < cases && i < most_tries; ++i) {
        const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
        const Case c = random_case(seed, theme);
        const auto setting = setting_number(seed);
        const auto outcome = compare_tiles(c, setting);
        INFO(c.describe() << "\n"
                          << stand_in::text(setting.schedule) << ", " << setting.block_threads
                          << " threads, " << setting.shared_bytes << " bytes of shared memory");
        CHECK(outcome.difference == "");
        matched += outcome.refused ? 0 : 1;
    }
    CHECK(matched == cases);
}

} // namespace hsgm::cuda_test
