// Matches small random pairs on the host and on the stand-in, with a mutant of the kernels, or
// with the kernels as they are. A mutant is caught where bits differ, where a detector of the
// stand-in speaks up, or where a sanitizer does.

#include "tests/cuda/comparison.h"
#include "tests/reference/themes.h"

#include <cstdio>
#include <cstdlib>

using namespace hsgm;

namespace {

constexpr int kCases = 40;

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
