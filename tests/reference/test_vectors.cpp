#include "tests/catch.h"

#include "tests/reference/themes.h"

#include <hwy/targets.h>

#include <vector>

using namespace hsgm::reference;

namespace {

// The instruction sets of this machine that any part of the matcher is compiled for. Where one
// part has no use for a set, it takes the next best.
std::vector<std::int64_t> instruction_sets()
{
    std::vector<std::int64_t> found;
    for (const std::int64_t target : {HWY_AVX3_DL, HWY_AVX3, HWY_AVX2, HWY_SSE4, HWY_SSSE3}) {
        if ((hwy::SupportedTargets() & target) != 0) {
            found.push_back(target);
        }
    }
    return found;
}

// Uses no better instructions than those of `target` while it lives.
class Limited {
public:
    explicit Limited(std::int64_t target)
    {
        hwy::SetSupportedTargetsForTest(hwy::SupportedTargets() & -target);
    }
    ~Limited() { hwy::SetSupportedTargetsForTest(0); }
    Limited(const Limited&) = delete;
    Limited& operator=(const Limited&) = delete;
};

} // namespace

TEST_CASE("matcher and twin agree at every vector length that this machine has")
{
    for (const std::int64_t target : instruction_sets()) {
        const Limited limited(target);
        INFO(hwy::TargetName(target));
        compare(tiny(), 1'100'000, 100);
        compare(small(), 1'200'000, 60);
        compare(pruned(), 1'300'000, 8);
        compare(dear(), 1'400'000, 40);
    }
}

TEST_CASE("matcher and twin agree for every cost, number of paths, width and vector length")
{
    for (const std::int64_t target : instruction_sets()) {
        const Limited limited(target);
        INFO(hwy::TargetName(target));
        std::uint64_t first = 1'500'000;
        for (const Cost cost : hsgm::matcher::all_costs()) {
            for (const int paths : {4, 5, 8, 16}) {
                for (const bool wide : {false, true}) {
                    compare(of_cost(cost, paths, wide), first += 100, 8);
                }
            }
        }
    }
}
