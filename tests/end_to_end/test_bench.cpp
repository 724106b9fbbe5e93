// `hsgm bench` as a user runs it, on pairs small enough for a test.

#include "tests/end_to_end/pairs.h"
#include "tests/end_to_end/rasters.h"

#include "matcher/instructions.h"
#include "pipeline/bench/bench_pair.h"
#include "tests/reference/work.h"

#include <algorithm>
#include <set>

using namespace hsgm::tests;
using Catch::Matchers::Contains;
using hsgm::bench::BenchPair;
using nlohmann::json;

namespace {

using Words = std::vector<std::string>;

// What the program measured, as JSON; the table for people goes to standard error.
json bench(Words more)
{
    more.insert(more.begin(), {"bench", "--json"});
    const Outcome outcome = hsgm_does(more);
    CHECK_THAT(outcome.err, Contains("time/base"));
    return json::parse(outcome.out);
}

std::vector<std::string> titles(const json& pair)
{
    std::vector<std::string> found;
    for (const json& m : pair["measured"]) {
        found.push_back(m["title"]);
    }
    return found;
}

std::set<std::string> keys_of(const json& object)
{
    std::set<std::string> keys;
    for (const auto& [key, value] : object.items()) {
        keys.insert(key);
    }
    return keys;
}

const std::set<std::string> kOfAll{
    "title",       "matcher",        "mode",         "threads",     "compared_with", "seconds",
    "cells_per_s", "time_over_base", "memory_bytes", "bad_percent", "cpu_seconds"};
const std::set<std::string> kOfOurs{"cost",   "paths", "prune",   "instructions",
                                    "device", "work",  "stages_s"};

void check_measured(const json& m, const json& pair)
{
    CAPTURE(m["title"]);
    std::set<std::string> keys = kOfAll;
    const bool ours = m["matcher"] == "hsgm";
    if (ours) {
        keys.insert(kOfOurs.begin(), kOfOurs.end());
    }
    CHECK(keys_of(m) == keys);
    const json& seconds = m["seconds"];
    CHECK(seconds["least"] > 0);
    CHECK(seconds["least"] <= seconds["median"]);
    CHECK(seconds["median"] <= seconds["most"]);
    CHECK(seconds["all"].size() >= 2);
    CHECK(m["cpu_seconds"]["all"].size() == seconds["all"].size());
    CHECK(m["cpu_seconds"]["least"] > 0);
    const double median = seconds["median"];
    const auto cells = [&](const char* kind) {
        return m["cells_per_s"][kind].get<double>() * median;
    };
    CHECK(cells("nominal") == Approx(pair["cells"]["nominal"].get<double>()));
    CHECK(cells("compared") == Approx(pair["cells"]["compared"].get<double>()));
    CHECK(cells("evaluated") ==
          Approx((ours ? m["work"]["cells"] : pair["cells"]["compared"]).get<double>()));
    CHECK(m["time_over_base"] > 0);
    CHECK(m["bad_percent"] >= 0);
    CHECK(m["bad_percent"] < 40);
    if (!m["memory_bytes"].is_null()) {
        CHECK(m["memory_bytes"]["added"] > 0);
        CHECK(m["memory_bytes"]["peak"] >= m["memory_bytes"]["added"]);
    }
}

} // namespace

TEST_CASE("bench measures every contender, and counts the cells that the twin counts")
{
    const json all = bench({"--side", "256", "--disparities", "32", "--repeats", "2",
                            "--threads", "1,2", "--peers", "hh,3way", "--cost",
                            "census7x7,census5x5", "--instructions", "auto", "--whole"});
    CHECK(all["repeats"] == 2);
    CHECK(all["inner_loops"].size() == 2); // 8 and 16 bits
    REQUIRE(all["pairs"].size() == 1);
    const json& pair = all["pairs"][0];
    CHECK(pair["rows"] == 256);
    CHECK(pair["cols"] == 256);
    CHECK(pair["compared_cols"] == 256 - 32);
    CHECK(pair["cells"]["nominal"] == 256 * 256 * 32);
    CHECK(pair["cells"]["compared"] == 256 * 224 * 32);
    CHECK(pair["span"]["of"] == "truth");
    CHECK(pair["span"]["percent"] >= 60);
    CHECK(pair["left_out"].empty());
    const std::string set(name(hsgm::matcher::usable_instructions().front()));
    CHECK(titles(pair) ==
          Words{"hsgm census7x7, " + set, "hsgm census7x7, " + set + ", not pruned",
                "hsgm census5x5, " + set, "OpenCV HH, 8 paths", "OpenCV 3WAY, 3 paths",
                "hsgm census7x7, " + set, "OpenCV HH, 8 paths", "OpenCV 3WAY, 3 paths"});
    for (const json& m : pair["measured"]) {
        check_measured(m, pair);
    }
    CHECK(pair["whole"]["seconds"]["all"].size() == 2);
    CHECK(pair["whole"]["threads"] == 1);
    CHECK(pair["whole"]["seconds"]["median"] > 0);

    const BenchPair images = hsgm::bench::render_pair("town", 256, 32);
    hsgm::reference::Options options;
    const auto twin =
        hsgm::reference::match(images.left, images.right, images.asked, {}, {}, options);
    const auto work = hsgm::reference::work_of(twin, options);
    const json& counted = pair["measured"][0]["work"];
    CHECK(counted["windows"] == work.windows);
    CHECK(counted["cells"] == work.cells);
    CHECK(counted["path_steps"] == work.path_steps);
    CHECK(pair["measured"][5]["work"] == counted);
    CHECK(pair["measured"][1]["work"]["cells"] >= work.cells);
}

TEST_CASE("bench takes two images, and says what it cannot compare")
{
    const TemporaryFolder folder;
    make_pair(folder, {120, 200});
    const Words images{folder / "left.tif", folder / "right.tif", "--disparity", "0,39"};
    const Words quick{"--repeats",      "1",    "--threads", "1",
                      "--peers",        "hh",   "--cost",    "census7x7",
                      "--instructions", "auto", "--set",     "matcher.p2=160"};
    Words command = images;
    command.insert(command.end(), quick.begin(), quick.end());
    const Snapshot before = snapshot(folder.path().string());
    const json pair = bench(command)["pairs"][0];
    CHECK(pair["rows"] == 120);
    CHECK(pair["disparity_max"] == 39);
    CHECK(pair["span"]["of"] == "result");
    CHECK(pair["span"]["low_px"] == Approx(5).margin(0.5));
    CHECK(pair["measured"].size() == 2);
    CHECK(pair["measured"][0]["bad_percent"].is_null());
    REQUIRE(pair["left_out"].size() == 1);
    CHECK_THAT(pair["left_out"][0]["why"], Contains("sixteens, and these are 40"));
    CHECK(pair["whole"].is_null());
    CHECK((snapshot(folder.path().string()) == before));
}

TEST_CASE("bench prints a table for people, one for each size and range")
{
    const std::string out = hsgm_does({"bench", "--side", "128,192", "--disparities", "16,32",
                                       "--repeats", "1", "--threads", "1", "--peers", "none",
                                       "--cost", "census7x7", "--instructions", "auto"})
                                .out;
    for (const char* sizes :
         {"128 x 128 px, disparities 0..15", "128 x 128 px, disparities 0..31",
          "192 x 192 px, disparities 0..15", "192 x 192 px, disparities 0..31"}) {
        CHECK_THAT(out, Contains(sizes));
    }
    CHECK_THAT(out, Contains("the content spans") && Contains("not pruned") &&
                        Contains("Its time: pyramid") && Contains("Inner loops"));
    CHECK_THAT(out, !Contains("OpenCV HH"));
}
