#include "tests/catch.h"

#include "pipeline/bench/measure.h"
#include "pipeline/bench/memory_match.h"
#include "tests/reference/work.h"
#include "tests/seam/stereo.h"

#include <tbb/global_control.h>

using namespace hsgm;
using namespace hsgm::bench;

namespace {

BenchPair bench_pair(const seam::StereoPair& stereo)
{
    BenchPair pair;
    pair.left = stereo.left;
    pair.right = stereo.right;
    pair.asked = stereo.asked;
    return pair;
}

matcher::MatchStatistics work_of_twin(const BenchPair& pair, const matcher::Options& options)
{
    const auto work = reference::work_of(
        reference::match(pair.left, pair.right, pair.asked, {}, {}, options), options);
    return {work.windows, work.cells, work.path_steps};
}

} // namespace

TEST_CASE("a match in memory has the bits of one that is put together from tiles")
{
    const auto stereo = seam::render(seam::city({150, 330}, 5));
    const BenchPair pair = bench_pair(stereo);
    matcher::Options options;
    options.cost = GENERATE(matcher::Cost::census7x7, matcher::Cost::hmi);
    options.mode = GENERATE(matcher::Mode::hsgm, matcher::Mode::sgm, matcher::Mode::local);
    options.median = GENERATE(1, 5);
    const seam::Match match(stereo, options);
    const matcher::Refined expected = match.refine_all(match.match_all(70), 64);
    for (const int tile_size_px : {0, 100}) {
        CAPTURE(name(options.mode), name(options.cost), tile_size_px);
        CHECK(seam::difference(match_in_memory(pair, options, tile_size_px).result, expected) ==
              "");
    }
}

TEST_CASE("an untiled match goes through the cells that the twin counts, tiles through more")
{
    const BenchPair pair = render_pair("town", 160, 32);
    matcher::Options options;
    options.prune = GENERATE(true, false);
    const MemoryMatch untiled = match_in_memory(pair, options, 0);
    CHECK((untiled.work == work_of_twin(pair, options)));
    const MemoryMatch tiled = match_in_memory(pair, options, 50);
    CHECK(tiled.work.windows > untiled.work.windows);
    CHECK(tiled.work.cells > untiled.work.cells);
}

TEST_CASE("the stages of a match take the time that it takes")
{
    const BenchPair pair = render_pair("town", 256, 64);
    const auto start = std::chrono::steady_clock::now();
    const StageSeconds s = match_in_memory(pair, {}, 0).seconds;
    const std::chrono::duration<double> all = std::chrono::steady_clock::now() - start;
    for (const double stage : {s.pyramid, s.coarse, s.windows, s.second}) {
        CHECK(stage > 0);
    }
    const double sum = s.pyramid + s.table + s.coarse + s.windows + s.second;
    CHECK(sum <= all.count());
    CHECK(s.windows > s.pyramid);
}
