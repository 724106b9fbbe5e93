#include "tests/catch.h"

#include "pipeline/evaluate/confidence_score.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

using namespace hsgm::evaluate;

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
const std::vector<double> kShares{0, 10, 20, 50};

// Ten pixels with truth 0: errors and confidences.
ConfidenceScore score_of(const std::vector<float>& errors, const std::vector<float>& confidence)
{
    ConfidenceScorer scorer(1);
    scorer.add_row(errors, std::vector<float>(errors.size(), 0.0F), confidence);
    return scorer.score(kShares);
}

} // namespace

TEST_CASE("a confidence that knows every error reaches the optimal area")
{
    std::vector<float> errors(1000, 0.5F);
    std::vector<float> confidence(1000, 200);
    for (std::size_t i = 0; i < 100; ++i) {
        errors[i] = 9;
        confidence[i] = 50;
    }
    const ConfidenceScore s = score_of(errors, confidence);
    CHECK(s.answered == 1000);
    REQUIRE(s.curve.size() == 4);
    CHECK(s.curve[0].bad_percent == Approx(10));
    CHECK(s.curve[1].bad_percent == Approx(0).margin(1e-9));
    CHECK(s.curve[3].bad_percent == Approx(0).margin(1e-9));
    CHECK(s.optimal_area_percent == Approx(100 * (0.1 + 0.9 * std::log(0.9))));
    CHECK(s.area_percent == Approx(s.optimal_area_percent));
}

TEST_CASE("a confidence that knows nothing keeps the share of errors")
{
    const ConfidenceScore s = score_of({0, 0, 0, 9, 9}, {7, 7, 7, 7, 7});
    for (const Sparsified& point : s.curve) {
        CHECK(point.bad_percent == Approx(40));
    }
    CHECK(s.area_percent == Approx(40));
}

TEST_CASE("a class cut in two counts with its mean share of errors")
{
    // The eight most confident hold two errors, the two least confident one.
    const ConfidenceScore s =
        score_of({0, 0, 0, 0, 0, 0, 9, 9, 9, 0}, {9, 9, 9, 9, 9, 9, 9, 9, 1, 1});
    CHECK(s.curve[0].bad_percent == Approx(30));
    CHECK(s.curve[1].bad_percent == Approx(100 * 2.5 / 9));
    CHECK(s.curve[2].bad_percent == Approx(25));
    CHECK(s.curve[3].bad_percent == Approx(25));
    REQUIRE(s.classes.size() == 2);
    CHECK(s.classes[0].confidence == 1);
    CHECK(s.classes[0].pixels == 2);
    CHECK(s.classes[0].within == 1);
    // The integral, summed in small steps.
    double sum = 0;
    const int steps = 100000;
    for (int i = 0; i < steps; ++i) {
        const double kept = 10 * (i + 0.5) / steps;
        sum += (kept < 8 ? 0.25 * kept : 2 + 0.5 * (kept - 8)) / kept;
    }
    CHECK(s.area_percent == Approx(100 * sum / steps).epsilon(1e-6));
}

TEST_CASE("calibration compares mean confidence with the share that is right")
{
    // Half of confidence 51 (0.2) are right, all of 255 (1.0).
    const ConfidenceScore s = score_of({0, 9, 0, 0}, {51, 51, 255, 255});
    const auto rows = calibration(s);
    CHECK(rows[2].share == Approx(0.5));
    CHECK(rows[2].confidence == Approx(0.2));
    CHECK(rows[2].within == Approx(0.5));
    CHECK(rows[9].confidence == Approx(1));
    CHECK(rows[9].within == Approx(1));
    CHECK(std::isnan(rows[0].within));
    CHECK(s.calibration_error == Approx(0.15));
}

TEST_CASE("pixels without truth, value or mask do not count for the confidence")
{
    ConfidenceScorer scorer(1);
    const std::vector<std::uint8_t> mask{1, 1, 0, 1};
    scorer.add_row(std::vector<float>{1, kNone, 3, 4}, std::vector<float>{kNone, 1, 3, 4},
                   std::vector<float>{1, 2, 3, 4}, mask);
    const ConfidenceScore s = scorer.score(kShares);
    CHECK(s.answered == 1);
    CHECK(s.classes[0].confidence == 4);
}

TEST_CASE("confidences that are none, and thresholds below zero, are refused")
{
    ConfidenceScorer scorer(1);
    const std::vector<float> one{1};
    CHECK_THROWS_AS(scorer.add_row(one, one, std::vector<float>{256}), std::invalid_argument);
    CHECK_THROWS_AS(scorer.add_row(one, one, std::vector<float>{kNone}), std::invalid_argument);
    CHECK_THROWS_WITH(ConfidenceScorer(-1), Catch::Contains("confidence threshold is -1"));
}

TEST_CASE("without a pixel there are no figures")
{
    const ConfidenceScore s = score_of({kNone}, {0});
    CHECK(std::isnan(s.curve[0].bad_percent));
    CHECK(std::isnan(s.area_percent));
}
