// How alike two images are, with answers that statistics give.

#include "tests/catch.h"

#include "pipeline/stages/pair_likeness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace hsgm;
using geometry::Likeness;
using tiling::Image;

namespace {

constexpr tiling::Size kSize{120, 160};
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

Image<double> noise(unsigned seed, double deviation)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, deviation);
    Image<double> image(kSize);
    std::generate_n(image.data(), kSize.area(), [&] { return normal(random); });
    return image;
}

Image<double> sum(const Image<double>& a, const Image<double>& b)
{
    Image<double> result(kSize);
    for (std::int64_t i = 0; i < kSize.area(); ++i) {
        result.data()[i] = a.data()[i] + b.data()[i];
    }
    return result;
}

Likeness of(const Image<double>& left, const Image<double>& right,
            const Image<float>& disparity)
{
    Likeness likeness;
    pipeline::add_windows(left, right, disparity, likeness);
    return likeness;
}

} // namespace

TEST_CASE("an image is like itself in another exposure, and unlike noise")
{
    const Image<double> texture = noise(1, 100);
    const Image<float> still(kSize, 0.0F);
    Image<double> exposed(kSize);
    for (std::int64_t i = 0; i < kSize.area(); ++i) {
        exposed.data()[i] = 3000 + 0.4 * texture.data()[i];
    }
    CHECK(of(texture, exposed, still).unlike_share() == 0);
    CHECK(of(texture, noise(2, 100), still).unlike_share() == 1);
    CHECK(of(texture, Image<double>(kSize, 7.0), still).unlike_share() == 1); // flat
    // A window every third row and column; the last column has no neighbour to lie between.
    CHECK(of(texture, exposed, still).windows == 38 * 51);
}

TEST_CASE("the noisier the images, the more of their windows are unlike")
{
    const Image<double> texture = noise(1, 100);
    const Image<float> still(kSize, 0.0F);
    double before = -1;
    // Their correlation is 1 / (1 + (noise / texture)^2): 0.96, 0.8, 0.61.
    for (const double deviation : {20.0, 50.0, 80.0}) {
        CAPTURE(deviation);
        const double unlike =
            of(sum(texture, noise(2, deviation)), sum(texture, noise(3, deviation)), still)
                .unlike_share();
        CHECK(unlike > before);
        before = unlike;
        if (deviation == 20.0) {
            CHECK(unlike < 0.01);
        } else if (deviation == 50.0) {
            CHECK(unlike > 0.3);
            CHECK(unlike < 0.7);
        } else {
            CHECK(unlike > 0.95);
        }
    }
}

TEST_CASE("windows are compared with what they were matched to")
{
    // The right image shows everything 4.5 columns further left.
    Image<double> left(kSize);
    Image<double> right(kSize);
    for (int row = 0; row < kSize.rows; ++row) {
        for (int col = 0; col < kSize.cols; ++col) {
            const auto tone = [row](double x) { return 50 * std::sin(0.4 * x + 0.7 * row); };
            left(row, col) = tone(col);
            right(row, col) = tone(col + 4.5);
        }
    }
    CHECK(of(left, right, Image<float>(kSize, 4.5F)).unlike_share() == 0);
    CHECK(of(left, right, Image<float>(kSize, 0.0F)).unlike_share() == 1);
    // Where there is no match, or only beyond the right image, nothing is compared.
    CHECK(of(left, right, Image<float>(kSize, kNone)).windows == 0);
    CHECK(of(left, right, Image<float>(kSize, 200.0F)).windows == 0);
    CHECK(of(left, right, Image<float>(kSize, kNone)).unlike_share() == 0);
    Image<float> half(kSize, 4.5F);
    for (int row = 0; row < kSize.rows; ++row) {
        for (int col = 80; col < kSize.cols; ++col) {
            half(row, col) = kNone;
        }
    }
    // Columns 5 to 79: windows that begin at 6, 9 ... 72.
    CHECK(of(left, right, half).windows == 38 * 23);
}

TEST_CASE("patches add up")
{
    const Image<double> texture = noise(1, 100);
    const Image<float> still(kSize, 0.0F);
    Likeness likeness;
    pipeline::add_windows(texture, texture, still, likeness);
    pipeline::add_windows(texture, noise(2, 100), still, likeness);
    CHECK(likeness.windows == 2 * 38 * 51);
    CHECK(likeness.unlike_share() == 0.5);
}
