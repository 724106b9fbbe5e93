#include "tests/catch.h"

#include "tests/seam/stereo.h"

#include "pipeline/evaluate/confidence_score.h"

#include <limits>
#include <vector>

using namespace hsgm;
using namespace hsgm::seam;

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

evaluate::ConfidenceScore confidence_of(const StereoPair& pair, const matcher::Options& options)
{
    const Match match(pair, options);
    const matcher::Refined refined = match.refine_all(match.match_all(0), 0);
    evaluate::ConfidenceScorer scorer(1);
    const auto cols = static_cast<std::size_t>(pair.left.cols());
    std::vector<float> test(cols);
    std::vector<float> confidence(cols);
    for (int row = 0; row < pair.left.rows(); ++row) {
        for (std::size_t i = 0; i < cols; ++i) {
            const int col = static_cast<int>(i);
            const float d = refined.disparity_px(row, col);
            test[i] = d == matcher::kNodataDisparity ? kNone : d;
            confidence[i] = refined.confidence(row, col);
        }
        scorer.add_row(test, pair.truth_px.view().row_span(row), confidence);
    }
    return scorer.score(std::vector<double>{0, 10, 20, 30});
}

} // namespace

TEST_CASE("dropping the least confident pixels of a city leaves fewer errors each time")
{
    const StereoPair pair = render(city({512, 640}, 3));
    matcher::Options options;
    options.min_confidence = 0;
    const evaluate::ConfidenceScore all = confidence_of(pair, options);
    REQUIRE(all.curve.size() == 4);
    for (std::size_t i = 1; i < all.curve.size(); ++i) {
        CHECK(all.curve[i].bad_percent < 0.75 * all.curve[i - 1].bad_percent);
    }
    CHECK(all.area_percent < all.curve[0].bad_percent / 4);
    CHECK(all.calibration_error < 0.1);
    // What the default takes away is what the scale says is wrong two times in five or more.
    std::int64_t low = 0;
    std::int64_t low_within = 0;
    for (const evaluate::ConfidenceClass& c : all.classes) {
        low += c.confidence < matcher::Options{}.min_confidence ? c.pixels : 0;
        low_within += c.confidence < matcher::Options{}.min_confidence ? c.within : 0;
    }
    CHECK(low > 500);
    CHECK(100 * low_within < 62 * low);
    const evaluate::ConfidenceScore kept = confidence_of(pair, matcher::Options{});
    CHECK(kept.answered < all.answered);
    CHECK(kept.classes.front().confidence >= matcher::Options{}.min_confidence);
}
