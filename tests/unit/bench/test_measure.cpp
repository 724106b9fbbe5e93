#include "tests/catch.h"

#include "pipeline/bench/measure.h"
#include "pipeline/bench/report.h"
#include "pipeline/error.h"
#include "tests/seam/stereo.h"

using namespace hsgm;
using namespace hsgm::bench;
using Catch::Matchers::Contains;

namespace {

const Log kQuiet = [](const std::string&) {};

BenchSettings small_settings()
{
    BenchSettings settings;
    settings.threads = {1, 2};
    settings.peers = {Peer::hh, Peer::three_way};
    settings.repeats = 2;
    return settings;
}

} // namespace

TEST_CASE("the median is the middle value, or the mean of two")
{
    CHECK(median({3}) == 3);
    CHECK(median({5, 1, 3}) == 3);
    CHECK(median({5, 1, 3, 4}) == 3.5);
}

TEST_CASE("every contender is timed in every round, right after what it is compared with")
{
    const BenchPair pair = render_pair("town", 256, 64);
    std::vector<std::string> steps;
    const PairResult result = measure_pair(
        pair, small_settings(), [&](const std::string& step) { steps.push_back(step); });
    REQUIRE(result.measured.size() == 7); // base, not pruned, 2 peers; base and 2 peers again
    CHECK(result.left_out.empty());
    CHECK(steps.size() == 7 + 2);
    for (std::size_t i = 0; i < result.measured.size(); ++i) {
        const Measured& m = result.measured[i];
        CAPTURE(m.contender.title, m.contender.threads);
        // The first is the base of 4 others, the fifth of 2.
        const std::size_t runs = i == 0 ? 4 : (i == 4 ? 1 + 2 : 1);
        CHECK(m.seconds.size() == 2 * runs);
        CHECK(m.over_base.size() == (i == 0 ? 0 : 2));
        CHECK(m.time_over_base() > 0);
        REQUIRE(m.bad_percent);
        CHECK(*m.bad_percent < 40);
        CHECK((m.work.cells > 0) == !m.contender.peer);
        CHECK(result.evaluated_cells(m) ==
              (m.contender.peer ? result.compared_cells() : m.work.cells));
    }
    CHECK(result.measured[0].time_over_base() == 1);
    CHECK(result.nominal_cells() == 256 * 256 * 64);
    CHECK(result.compared_cells() == 256 * (256 - 64) * 64);
    CHECK(result.measured[1].work.cells > result.measured[0].work.cells);
    CHECK(result.measured[4].work == result.measured[0].work);
    CHECK(result.measured[4].bad_percent == result.measured[0].bad_percent);
    CHECK(result.span_of_truth);
}

TEST_CASE("a pair without truth is measured, and its span is that of what was found")
{
    const auto stereo = seam::render(seam::city({100, 200}, 3));
    BenchPair pair;
    pair.left = stereo.left;
    pair.right = stereo.right;
    pair.asked = {-8, 31};
    BenchSettings settings = small_settings();
    settings.repeats = 1;
    const PairResult result = measure_pair(pair, settings, kQuiet);
    CHECK_FALSE(result.span_of_truth);
    CHECK(result.span.percent > 30);
    CHECK(result.span.low_px >= -8);
    for (const Measured& m : result.measured) {
        CHECK_FALSE(m.bad_percent);
        CHECK_FALSE(m.contender.peer); // 40 disparities
    }
    REQUIRE(result.left_out.size() == 4);
    CHECK_THAT(result.left_out[0].why, Contains("sixteens, and these are 40"));
    CHECK_THAT(table({settings, {}, {result}}), Contains("left out: OpenCV counts"));
}

TEST_CASE("what cannot fit the memory is refused before it is tried")
{
    const matcher::PairShape huge{{2'000'000, 2'000'000}, {2'000'000, 2'000'000}, {0, 127}};
    CHECK_THROWS_AS(check_memory(huge, {}), pipeline::BudgetError);
    CHECK_THROWS_WITH(check_memory(huge, {}),
                      Contains("of memory, and") && Contains("choose a smaller side"));
    CHECK_NOTHROW(check_memory({{256, 256}, {256, 256}, {0, 63}}, {}));
}
