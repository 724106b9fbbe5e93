// Matches small random pairs on the host and on the stand-in, with a mutant of the kernels, or
// with the kernels as they are. A mutant is caught where bits differ, where a detector of the
// stand-in speaks up, or where a sanitizer does.

#include "tests/cuda/comparison.h"
#include "tests/reference/themes.h"

#include <cstdio>
#include <cstdlib>

using namespace hsgm;

namespace {

// With sanitizers, which are slow, a mutant is caught in the first few or not at all.
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
constexpr int kCases = 12;
#else
constexpr int kCases = 40;
#endif

reference::Theme theme()
{
    reference::Theme theme;
    theme.most_side_px = 70;
    theme.least_count = 10;
    theme.most_count = 60;
    theme.most_work = 120'000;
    theme.vary = [](reference::Random& random, reference::Options& o) {
        o = {};
        o.cost = reference::Cost::census5x5;
        o.levels = random.between(2, 3);
        o.window_px = random.one_of({16, 32});
        o.halo_px = random.one_of({0, 4, 8});
        o.prune = random.chance(50);
    };
    return theme;
}

} // namespace

// One report of a race is enough, and takes long to write.
// NOLINTNEXTLINE(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" const char* __tsan_default_options()
{
    return "halt_on_error=1";
}

int main()
{
    for (std::uint64_t seed = 1; seed <= kCases; ++seed) {
        const reference::Case c = reference::random_case(seed, theme());
        cuda_test::Setting setting = cuda_test::setting_number(seed);
        setting.block_threads = 64;
        const auto outcome = cuda_test::compare_tiles(c, setting);
        if (!outcome.difference.empty()) {
            std::printf("caught by its bits: %s\n", outcome.difference.c_str());
            return EXIT_FAILURE;
        }
    }
    std::puts("nothing was caught");
    return EXIT_SUCCESS;
}
