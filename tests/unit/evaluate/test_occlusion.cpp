#include "tests/catch.h"

#include "pipeline/evaluate/occlusion.h"

#include <limits>
#include <vector>

using namespace hsgm::evaluate;

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
using Mask = std::vector<std::uint8_t>;

} // namespace

TEST_CASE("cross-check keeps pixels whose two truths agree within a pixel")
{
    // Ground d = 0; a block of d = 2 over left columns 3 and 4: right columns 1 and 2. The
    // ground's columns 1 and 2 are hidden there; right columns 3 and 4 show what left hides.
    const std::vector<float> left{0, 0, 0, 2, 2, 0, kNone};
    const std::vector<float> right{0, 2, 2, 0, 0, 1, 0};
    Mask mask(7);
    nonoccluded_by_cross_check(left, right, mask);
    CHECK(mask == Mask{255, 0, 0, 255, 255, 255, 0});
    nonoccluded_by_cross_check(left, right, mask, 0.5);
    CHECK(mask == Mask{255, 0, 0, 255, 255, 0, 0});
}

TEST_CASE("cross-check drops pixels that leave the right image or meet no truth")
{
    const std::vector<float> left{1, 1, -1, 0.5f};
    const std::vector<float> right{kNone, 0, 0, 0};
    Mask mask(4);
    nonoccluded_by_cross_check(left, right, mask);
    // Column 0 lands on -1; 1 on 0, unknown; 2 on 3; 3 on 2.5, which rounds up to 3.
    CHECK(mask == Mask{0, 0, 255, 255});
}

TEST_CASE("the z-buffer drops what lands behind something nearer")
{
    const std::vector<float> left{0, 0, 0, 2, 2, 0, kNone};
    Mask mask(7);
    nonoccluded_by_zbuffer(left, 7, mask);
    CHECK(mask == Mask{255, 0, 0, 255, 255, 255, 0});
}

TEST_CASE("the z-buffer keeps a slope whose neighbours share a column")
{
    const std::vector<float> left{0, 0.5f, 1, 1.5f, 2, 2.5f};
    Mask mask(6);
    nonoccluded_by_zbuffer(left, 6, mask);
    CHECK(mask == Mask(6, 255));
    nonoccluded_by_zbuffer(left, 6, mask, 0);
    // Landing, rounded: 0, 1, 1, 2, 2, 3.
    CHECK(mask == Mask{255, 0, 255, 0, 255, 255});
}
