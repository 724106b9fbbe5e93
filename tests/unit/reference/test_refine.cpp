#include "tests/catch.h"

#include "matcher/reasons.h"
#include "tests/reference/refine.h"
#include "tests/unit/reference/images.h"

using namespace hsgm::reference;
namespace matcher = hsgm::matcher;

TEST_CASE("the twin tells mismatches from occlusions")
{
    // Right winners 3, 1, none, 0 with disparities from 0.
    const auto keys = image_of<std::uint32_t>({{5u << 16 | 3, 9u << 16 | 1, kNoKey, 4u << 16}});
    const DisparityRange asked{0, 3};
    const auto reason = [&](int x, int winner, int tolerance) {
        return left_right_reason(keys, 0, x, winner, asked, tolerance);
    };
    CHECK(reason(3, 3, 0) == 0);
    CHECK(reason(3, 2, 1) == 0);
    CHECK(reason(3, 0, 0) == 0);
    CHECK(reason(0, 1, 0) == matcher::kOutside);
    CHECK(reason(3, 1, 0) == matcher::kInconsistent); // no right winner; 3 and 0 agree
    CHECK(reason(2, 1, 0) == 0);
    CHECK(reason(2, 0, 0) == matcher::kInconsistent); // 1 agrees
    CHECK(reason(1, 0, 0) == matcher::kOccluded);     // right winners 1 and 3 for 0 and 1
    CHECK(reason(1, 0, 1) == 0);
    CHECK(reason(0, 0, 2) == matcher::kOccluded);
    CHECK(reason(0, 0, 3) == 0);
}

TEST_CASE("the twin's disparities of keys start at the first asked one")
{
    const auto keys = image_of<std::uint32_t>({{7u << 16 | 2}});
    CHECK(left_right_reason(keys, 0, 0, 0, {-2, 0}, 0) == 0);
    CHECK(left_right_reason(keys, 0, 0, 0, {-3, 0}, 0) == matcher::kOccluded);
}

TEST_CASE("the twin's median passes over pixels without a value")
{
    const auto values = image_of<std::int32_t>({{10, 30, 20, 99}});
    const std::uint16_t gone = matcher::kOccluded;
    const std::uint16_t flat = matcher::kLowTexture;
    const auto reasons = pixels({{0, flat, 0, gone}});
    CHECK(median_of_valid(values, reasons, 0, 0, 3) == 10); // of 10 30, the lower
    CHECK(median_of_valid(values, reasons, 0, 1, 3) == 20);
    CHECK(median_of_valid(values, reasons, 0, 2, 3) == 20); // of 20 30
    CHECK(median_of_valid(values, reasons, 0, 0, 5) == 20);
    CHECK(median_of_valid(values, reasons, 0, 1, 1) == 30);

    const auto column = image_of<std::int32_t>({{5}, {1}, {9}});
    CHECK(median_of_valid(column, pixels({{0}, {0}, {0}}), 1, 0, 3) == 5);
}

TEST_CASE("the twin's mean is that of one surface, rounded to the nearest")
{
    Surface surface;
    surface.q8 = image_of<std::int32_t>({{-1024, -1020, -767, -768, 5000}});
    surface.has_value = image_of<std::uint8_t>({{1, 1, 1, 0, 1}});
    CHECK(mean_of_near(surface, 0, 0, 1) == -1024);
    CHECK(mean_of_near(surface, 0, 0, 3) == -1022);
    CHECK(mean_of_near(surface, 0, 0, 5) == -1022); // the third is 257 away
    CHECK(mean_of_near(surface, 0, 1, 5) == -937);  // -2811 / 3
    CHECK(mean_of_near(surface, 0, 2, 3) == -893);  // -893.5
    CHECK(mean_of_near(surface, 0, 4, 5) == 5000);
}
