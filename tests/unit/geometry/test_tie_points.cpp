#include "tests/catch.h"

#include "pipeline/geometry/tie_points.h"
#include "tests/unit/geometry/window_matching.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

using namespace hsgm;
using namespace hsgm::geometry;

namespace {

/// Smooth noise, the same for everybody.
double hashed(int x, int y)
{
    std::uint32_t h =
        static_cast<std::uint32_t>(x) * 374761393u + static_cast<std::uint32_t>(y) * 668265263u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return static_cast<double>((h ^ (h >> 16)) & 0xffff) / 65535.0;
}

double texture(double x, double y)
{
    double sum = 0;
    for (const double scale : {3.0, 7.0, 17.0}) {
        const int x0 = static_cast<int>(std::floor(x / scale));
        const int y0 = static_cast<int>(std::floor(y / scale));
        double tx = x / scale - x0;
        double ty = y / scale - y0;
        tx = tx * tx * (3 - 2 * tx);
        ty = ty * ty * (3 - 2 * ty);
        sum += (1 - ty) * ((1 - tx) * hashed(x0, y0) + tx * hashed(x0 + 1, y0)) +
               ty * ((1 - tx) * hashed(x0, y0 + 1) + tx * hashed(x0 + 1, y0 + 1));
    }
    return 1000 + 300 * sum;
}

constexpr double kDisparity = 11.3;
constexpr double kRowParallax = 1.6;

tiling::Image<double> left_image()
{
    tiling::Image<double> image({220, 260});
    for (int r = 0; r < 220; ++r) {
        for (int c = 0; c < 260; ++c) {
            image(r, c) = texture(c, r);
        }
    }
    return image;
}

/// Begins 30 columns before the left one; darker, with less contrast.
tiling::Image<double> right_image()
{
    tiling::Image<double> image({220, 300});
    for (int r = 0; r < 220; ++r) {
        for (int c = 0; c < 300; ++c) {
            image(r, c) = 0.7 * texture(c - 30 + kDisparity, r + kRowParallax) + 100;
        }
    }
    return image;
}

} // namespace

TEST_CASE("features of two shifted pictures are matched, in frame coordinates")
{
    const auto left = left_image();
    const auto right = right_image();
    const auto points =
        match_features({1000, 2000, left}, {1000, 1970, right}, {-20, 40, 0, 10}, 1000);
    REQUIRE(points.size() > 100);
    double rows = 0;
    double cols = 0;
    double right_ones = 0;
    for (const TiePoint& p : points) {
        CHECK(p.left.row >= 1000);
        CHECK(p.left.col >= 2000);
        if (std::abs(p.disparity_px() - kDisparity) < 1 &&
            std::abs(p.row_parallax_px() - kRowParallax) < 1) {
            ++right_ones;
            rows += p.row_parallax_px();
            cols += p.disparity_px();
        }
    }
    CHECK(right_ones > 0.95 * static_cast<double>(points.size()));
    CHECK(rows / right_ones == Approx(kRowParallax).margin(0.02));
    CHECK(cols / right_ones == Approx(kDisparity).margin(0.02));
    CHECK(std::is_sorted(points.begin(), points.end(),
                         [](const auto& a, const auto& b) { return a.left.row < b.left.row; }));
}

TEST_CASE("nothing is matched outside the gate")
{
    const auto left = left_image();
    const auto right = right_image();
    for (const TieGate gate : {TieGate{-20, 5, 0, 10}, TieGate{-20, 40, -8, 3}}) {
        for (const TiePoint& p : match_features({0, 0, left}, {0, -30, right}, gate, 1000)) {
            CHECK(p.disparity_px() >= gate.disparity_min_px);
            CHECK(p.disparity_px() <= gate.disparity_max_px);
            CHECK(std::abs(p.row_parallax_px() - gate.row_parallax_px) <=
                  gate.row_tolerance_px);
        }
    }
}

TEST_CASE("the same pictures give the same points, to the bit")
{
    const auto left = left_image();
    const auto right = right_image();
    const TieGate gate{-20, 40, 0, 10};
    const auto a = match_features({0, 0, left}, {0, -30, right}, gate, 1000);
    const auto b = match_features({0, 0, left}, {0, -30, right}, gate, 1000);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        REQUIRE(a[i].left.row == b[i].left.row);
        REQUIRE(a[i].left.col == b[i].left.col);
        REQUIRE(a[i].right.row == b[i].right.row);
        REQUIRE(a[i].right.col == b[i].right.col);
    }
}

TEST_CASE("no feature lies in or beside pixels without a value")
{
    auto left = left_image();
    const auto right = right_image();
    for (int r = 80; r < 140; ++r) {
        for (int c = 100; c < 160; ++c) {
            left(r, c) = std::numeric_limits<double>::quiet_NaN();
        }
    }
    const auto points = match_features({0, 0, left}, {0, -30, right}, {-20, 40, 0, 10}, 1000);
    REQUIRE(points.size() > 50);
    for (const TiePoint& p : points) {
        const bool inside =
            p.left.row > 75 && p.left.row < 144 && p.left.col > 95 && p.left.col < 164;
        CHECK_FALSE(inside);
    }
}

TEST_CASE("pictures without a value, or without features, or too small, have no tie points")
{
    const auto right = right_image();
    const TieGate gate{-20, 40, 0, 10};
    const tiling::Image<double> none({100, 100}, std::numeric_limits<double>::quiet_NaN());
    const tiling::Image<double> flat({100, 100}, 7.0);
    const tiling::Image<double> small({10, 100}, 7.0);
    for (const auto* image : {&none, &flat, &small}) {
        CHECK(match_features({0, 0, *image}, {0, -30, right}, gate).empty());
        CHECK(match_features({0, -30, right}, {0, 0, *image}, gate).empty());
    }
}

TEST_CASE("matching windows finds the shift to a hundredth of a pixel")
{
    const auto left = left_image();
    const auto right = right_image();
    std::vector<TiePoint> guesses;
    for (double row = 30; row < 190; row += 20) {
        for (double col = 40; col < 220; col += 20) {
            guesses.push_back({{row, col}, {row - kRowParallax + 0.4, col - kDisparity - 0.3}});
        }
    }
    const auto points = samples::match_windows(guesses, {0, 0, left}, {0, -30, right}, 7, 0.8);
    CHECK(points.size() > guesses.size() * 9 / 10);
    double rows = 0;
    for (const TiePoint& p : points) {
        CHECK(p.row_parallax_px() == Approx(kRowParallax).margin(0.05));
        CHECK(p.disparity_px() == Approx(kDisparity).margin(0.05));
        rows += p.row_parallax_px();
    }
    CHECK(rows / static_cast<double>(points.size()) == Approx(kRowParallax).margin(0.01));
}
