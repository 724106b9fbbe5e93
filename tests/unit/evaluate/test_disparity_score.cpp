#include "tests/catch.h"

#include "pipeline/evaluate/disparity_score.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

using namespace hsgm::evaluate;

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

} // namespace

TEST_CASE("a pixel is bad strictly above the threshold, and missing pixels are bad")
{
    DisparityScorer scorer({0.5, 1});
    //                          0    0.5   1    1.5  missing  no truth
    const std::vector<float> test{5, 5.5f, 4, 6.5f, kNone, 3};
    const std::vector<float> truth{5, 5, 5, 5, 5, kNone};
    scorer.add_row(test, truth);
    const DisparityScore s = scorer.score();
    CHECK(s.evaluated == 5);
    CHECK(s.answered == 4);
    CHECK(s.density_percent == Approx(80));
    REQUIRE(s.bad.size() == 2);
    CHECK(s.bad[0].bad_percent == Approx(60));
    CHECK(s.bad[0].bad_answered_percent == Approx(50));
    CHECK(s.bad[1].bad_percent == Approx(40));
    CHECK(s.bad[1].bad_answered_percent == Approx(25));
    CHECK(s.mean_error_px == Approx((0 + 0.5 - 1 + 1.5) / 4));
    CHECK(s.mean_absolute_error_px == Approx(3.0 / 4));
    CHECK(s.rmse_px == Approx(std::sqrt((0.25 + 1 + 2.25) / 4)));
}

TEST_CASE("pixels outside the mask do not count")
{
    DisparityScorer scorer({1});
    const std::vector<float> test{1, 2, 3};
    const std::vector<float> truth{1, 9, 9};
    const std::vector<std::uint8_t> mask{255, 0, 1};
    scorer.add_row(test, truth, mask);
    CHECK(scorer.score().evaluated == 2);
    CHECK(scorer.score().bad[0].bad_percent == Approx(50));
}

TEST_CASE("infinities count as missing")
{
    DisparityScorer scorer({1});
    const float infinity = std::numeric_limits<float>::infinity();
    scorer.add_row(std::vector<float>{infinity, 1}, std::vector<float>{1, infinity});
    CHECK(scorer.score().evaluated == 1);
    CHECK(scorer.score().answered == 0);
}

TEST_CASE("median and NMAD ignore a few gross errors")
{
    DisparityScorer scorer;
    // Errors -0.25, 0, 0.25, 0.5, 100: median 0.25; deviations 0.5, 0.25, 0, 0.25, 99.75.
    scorer.add_row(std::vector<float>{-0.25f, 0, 0.25f, 0.5f, 1000},
                   std::vector<float>(5, 0.0f));
    CHECK(scorer.score().median_error_px == 0.25);
    CHECK(scorer.score().nmad_px == Approx(1.4826 * 0.25));
}

TEST_CASE("a score of nothing is not a number")
{
    const DisparityScore s = DisparityScorer().score();
    CHECK(s.evaluated == 0);
    CHECK(std::isnan(s.density_percent));
    CHECK(std::isnan(s.bad[0].bad_percent));
    CHECK(std::isnan(s.nmad_px));
    CHECK_THROWS_AS(DisparityScorer({-1}), std::invalid_argument);
}
