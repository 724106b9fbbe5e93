#include "tests/catch.h"

#include "pipeline/evaluate/coregistration.h"
#include "pipeline/evaluate/surface_score.h"

#include <cmath>
#include <limits>
#include <stdexcept>

using namespace hsgm::evaluate;

TEST_CASE("a surface's score counts missing heights as not within")
{
    SurfaceScorer scorer({0.5, 1});
    for (const double error_m : {-0.5, 0.25, 0.75, 3.0}) {
        scorer.add(error_m);
    }
    scorer.add(std::numeric_limits<double>::quiet_NaN());
    const SurfaceScore s = scorer.score();
    CHECK(s.evaluated == 5);
    CHECK(s.answered == 4);
    CHECK(s.completeness_percent == Approx(80));
    CHECK(s.within[0].percent == Approx(40)); // -0.5 is within 0.5
    CHECK(s.within[0].answered_percent == Approx(50));
    CHECK(s.within[1].percent == Approx(60));
    CHECK(s.mean_error_m == Approx(0.875));
    CHECK(s.median_error_m == Approx(0.25)); // the lower one of an even count
    CHECK(s.rmse_m == Approx(std::sqrt((0.25 + 0.0625 + 0.5625 + 9) / 4)));
    CHECK(s.nmad_m == Approx(1.4826 * 0.5)); // distances 0, 0.5, 0.75, 2.75
    CHECK(s.le90_m == Approx(3));            // nine tenths of four are all four
}

TEST_CASE("LE90 leaves out a tenth and looks at both signs")
{
    SurfaceScorer scorer;
    for (int i = 1; i <= 10; ++i) {
        scorer.add(i % 2 == 0 ? i * 0.1 : -i * 0.1);
    }
    CHECK(scorer.score().le90_m == Approx(0.9));
}

TEST_CASE("a surface's score of nothing is not a number")
{
    const SurfaceScore s = SurfaceScorer().score();
    CHECK(s.evaluated == 0);
    CHECK(std::isnan(s.rmse_m));
    CHECK(std::isnan(s.nmad_m));
    CHECK(std::isnan(s.le90_m));
    CHECK(std::isnan(s.completeness_percent));
    CHECK_THROWS_AS(SurfaceScorer({-1}), std::invalid_argument);
}

TEST_CASE("a shift is found from slopes, outliers left out")
{
    ShiftFit fit(0, 5);
    const SurfaceShift truth{1.5, -0.75, 0.5};
    for (int i = 0; i < 400; ++i) {
        const double east = 0.3 * std::sin(0.7 * i);
        const double north = 0.2 * std::cos(1.3 * i);
        fit.add(truth.up - truth.east * east - truth.north * north, east, north);
        fit.add(40, east, north);
        fit.add(0, std::numeric_limits<double>::quiet_NaN(), north);
    }
    CHECK(fit.cells() == 400);
    const auto found = fit.shift();
    REQUIRE(found.has_value());
    CHECK(found->east == Approx(truth.east));
    CHECK(found->north == Approx(truth.north));
    CHECK(found->up == Approx(truth.up));
}

TEST_CASE("flat ground and slopes of one direction show no horizontal shift")
{
    ShiftFit flat(0, 5);
    ShiftFit tilted(0, 5);
    CHECK_FALSE(flat.up().has_value());
    for (int i = 0; i < 1000; ++i) {
        flat.add(0.25, 0, 0);
        const double slope = 0.4 * std::sin(0.1 * i);
        tilted.add(0.25 - 0.5 * slope, slope, 2 * slope);
    }
    CHECK_FALSE(flat.shift().has_value());
    CHECK(flat.up() == Approx(0.25));
    CHECK_FALSE(tilted.shift().has_value());
}
