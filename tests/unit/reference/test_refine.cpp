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

namespace {

// Values in 1/256 px that all exist, but for holes.
constexpr std::int32_t kHole = -1;

Surface surface_of(const std::vector<std::vector<std::int32_t>>& rows)
{
    Surface surface;
    const Size size{static_cast<int>(rows.size()), static_cast<int>(rows[0].size())};
    surface.q8 = Image<std::int32_t>(size);
    surface.winners = Image<int>(size);
    surface.has_value = Image<std::uint8_t>(size);
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            const std::int32_t value = rows[std::size_t(row)][std::size_t(col)];
            surface.q8(row, col) = value;
            surface.winners(row, col) = (value + 127) / 256;
            surface.has_value(row, col) = value == kHole ? 0 : 1;
        }
    }
    return surface;
}

// One gray level a pixel, all different.
Image<std::uint16_t> stairs(Size size, int step)
{
    Image<std::uint16_t> image(size);
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            image(row, col) = static_cast<std::uint16_t>(1000 + step * (size.cols * row + col));
        }
    }
    return image;
}

} // namespace

TEST_CASE("the twin's segments end where neighbours differ by more than the range")
{
    const Surface surface =
        surface_of({{0, 256, 512, 900}, {kHole, kHole, 768, kHole}, {0, 10, kHole, 768}});
    CHECK(segment_sizes(surface, 256) ==
          image_of<int>({{4, 4, 4, 1}, {0, 0, 4, 0}, {2, 2, 0, 1}}));
    CHECK(segment_sizes(surface, 388) ==
          image_of<int>({{5, 5, 5, 5}, {0, 0, 5, 0}, {2, 2, 0, 1}}));
}

TEST_CASE("the twin's holes look in eight directions, as far as told")
{
    const Surface surface = surface_of(
        {{10, kHole, 30, kHole}, {kHole, kHole, kHole, 40}, {kHole, kHole, 50, kHole}});
    using Values = std::vector<std::int32_t>;
    CHECK(values_around(surface, 1, 1, 1) == Values{10, 30, 50});
    CHECK(values_around(surface, 1, 1, 2) == Values{10, 30, 40, 50});
    CHECK(values_around(surface, 2, 0, 1).empty());
    CHECK(values_around(surface, 2, 0, 2) == Values{10, 30, 50});
}

TEST_CASE("the twin's sparse census sees sixteen neighbours, darker ones as ones")
{
    const auto rising = stairs({9, 9}, 1);
    CHECK(sparse_census_at(rising, 4, 4).to_ulong() == 0x00FF); // the two rows above
    CHECK(sparse_census_at(stairs({9, 9}, -1), 4, 4).to_ulong() == 0xFF00);
    // Replicated at the corner: rows above are the corner's own, columns before it, too.
    CHECK(sparse_census_at(rising, 0, 0).to_ulong() == 0);
}

TEST_CASE("the twin counts half of the bits where there is nothing to compare")
{
    const auto left = stairs({9, 9}, 1);
    auto right = stairs({9, 9}, -1);
    CHECK(differing_bits(left, left, 4, 4, 0) == 0);
    CHECK(differing_bits(left, right, 4, 4, 0) == 16);
    CHECK(differing_bits(left, right, 4, 4, 5) == 8);
    CHECK(differing_bits(left, right, 4, 4, -5) == 8);
    right(4, 4) = kNodata;
    CHECK(differing_bits(left, right, 4, 4, 0) == 8);
}

TEST_CASE("the twin keeps the fraction of the sums where the census says nothing")
{
    // Equal in all disparities: H is 0 everywhere, so a : b = 128 + min(o, 0) : 128 - max(o,
    // 0).
    const Image<std::uint16_t> flat({9, 40}, std::uint16_t{7});
    for (const std::int32_t value : {20 * 256, 20 * 256 + 60, 20 * 256 - 60, 20 * 256 + 128}) {
        Surface surface = surface_of(std::vector(9, std::vector<std::int32_t>(40, value)));
        CHECK(census_fraction(flat, flat, surface, {0, 40}, 4, 30) == value);
        CHECK(census_fraction(flat, flat, surface, {20, 40}, 4, 30) == value);
    }
}

TEST_CASE("the twin trusts a pixel by its neighbours and their margins")
{
    Surface surface = surface_of(std::vector(11, std::vector<std::int32_t>(11, 2560)));
    const Image<std::uint8_t> margins({11, 11}, std::uint8_t{255});
    const Image<std::uint8_t> none({11, 11}, std::uint8_t{1});
    // Sixteen neighbours agree closely: 16 * 2 * 200 + 25 * 255 = 12775, the last entry.
    CHECK(confidence_at(surface, margins, 5, 5) == 255);
    // At the corner 6 are left, and 9 margins: 6 * 2 * 200 + 9 = 2409, entry 4.
    CHECK(confidence_at(surface, none, 0, 0) == 121);
    surface.q8(0, 2) += 65;  // no longer close: 2209
    surface.q8(2, 0) += 385; // no longer wide: 1809, entry 3
    CHECK(confidence_at(surface, none, 0, 0) == 102);
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
