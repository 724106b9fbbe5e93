#include "tests/catch.h"

#include "matcher/noise.h"

#include <cmath>
#include <cstdint>
#include <random>

using namespace hsgm::matcher;
using hsgm::tiling::Image;

namespace {

// A slope, on which the estimate sees nothing but the noise.
Image<std::uint16_t> slope(double deviation, int rows = 256, int cols = 256)
{
    std::mt19937 bits(5);
    Image<std::uint16_t> image({rows, cols});
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < cols; ++c) {
            double twelve = -6; // the sum of twelve uniform numbers is nearly normal
            for (int i = 0; i < 12; ++i) {
                twelve += static_cast<double>(bits() % 65536) / 65535;
            }
            image(r, c) = static_cast<std::uint16_t>(
                std::lround(1000 + 2 * r + 3 * c + deviation * twelve));
        }
    }
    return image;
}

} // namespace

TEST_CASE("noise is the standard deviation of what is added to smooth ground")
{
    CHECK(noise_of(slope(0).view()) == 0);
    CHECK(noise_of(slope(0.3).view()) == 0);
    for (const double deviation : {2.0, 10.0, 60.0}) {
        CAPTURE(deviation);
        // The calmest tenth of the blocks: a sixth below the mean.
        CHECK(noise_of(slope(deviation).view()) <= deviation);
        CHECK(noise_of(slope(deviation).view()) >= 0.75 * deviation);
    }
}

TEST_CASE("texture in most of an image is not taken for its noise")
{
    auto image = slope(4);
    for (int r = 0; r < 200; ++r) {
        for (int c = 0; c < 256; ++c) {
            image(r, c) = static_cast<std::uint16_t>(image(r, c) + 400 * ((r / 2 + c / 2) % 2));
        }
    }
    CHECK(noise_of(image.view()) == 4);
}

TEST_CASE("padding, clipped lights and blocks with nodata do not count as calm")
{
    auto image = slope(6);
    const int noise = noise_of(image.view().part({128, 0, 128, 256}));
    for (int r = 0; r < 128; ++r) {
        for (int c = 0; c < 256; ++c) {
            image(r, c) = r < 64 ? 0 : kNodataPixel;
        }
    }
    CHECK(noise_of(image.view()) == noise);
    CHECK(noise_of(Image<std::uint16_t>({64, 64}, kNodataPixel).view()) == 0);
    CHECK(noise_of(slope(6, 7, 300).view()) == 0); // no whole block
}

TEST_CASE("noise has an upper end")
{
    CHECK(noise_of(slope(9000).view()) == kMostNoise);
}

TEST_CASE("an image without noise takes the tolerance from its pair")
{
    Tone left{0, 255, 0};
    Tone right{100, 1120, 4};
    CHECK(left.tolerance() == 0);
    CHECK(right.tolerance() == 4); // one tone
    agree_on_noise(left, right);
    CHECK(right.tolerance() == 0);
    left.noise = 2;
    right.noise = 9;
    agree_on_noise(left, right);
    CHECK(left.tolerance() == 1);
    CHECK(right.noise == 9);
}
