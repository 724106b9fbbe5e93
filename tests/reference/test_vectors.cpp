#include "tests/catch.h"

#include "tests/reference/themes.h"

#include <hwy/targets.h>

using namespace hsgm::reference;

TEST_CASE("matcher and twin agree at every vector length that this machine has")
{
    for (const std::int64_t target : {HWY_AVX3, HWY_AVX2, HWY_SSE4, HWY_SSSE3}) {
        if ((hwy::SupportedTargets() & target) == 0) {
            continue;
        }
        hwy::SetSupportedTargetsForTest(target);
        INFO(hwy::TargetName(target));
        compare(tiny(), 1'100'000, 100);
        compare(small(), 1'200'000, 60);
        compare(pruned(), 1'300'000, 8);
        compare(dear(), 1'400'000, 40);
        hwy::SetSupportedTargetsForTest(0);
    }
}
