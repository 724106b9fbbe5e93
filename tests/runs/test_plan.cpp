#include "tests/runs/run_place.h"

#include "tests/catch.h"

#include <nlohmann/json.hpp>

#include <filesystem>

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

// Lengths of all files; disks round them up to their blocks.
std::uintmax_t bytes_below(const std::filesystem::path& folder)
{
    std::uintmax_t bytes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        bytes += entry.is_regular_file() ? entry.file_size() : 0;
    }
    return bytes;
}

Outcome plan(const RunPlace& place, const std::vector<std::string>& more)
{
    std::vector<std::string> words{"plan", place / "run.yaml", "--tile-size",
                                   "64",   "--threads",        "2"};
    words.insert(words.end(), more.begin(), more.end());
    Outcome outcome = run_hsgm(words);
    INFO(outcome.err);
    CHECK(outcome.code == 0);
    return outcome;
}

} // namespace

TEST_CASE("a plan with shards tells what each of them then does")
{
    const RunPlace place;
    constexpr int kShards = 3;
    const json parts =
        json::parse(plan(place, {"--shards", "3", "--json", "--no-time"}).out)["parts"];
    REQUIRE(parts.size() == kShards + 2);
    CHECK(parts.front()["part"] == "coarse");
    CHECK(parts.back()["part"] == "assemble");
    place.run_to(0, {"--stage", "coarse"});
    const std::filesystem::path work = place.result() + "/work";
    CHECK(bytes_below(work) == parts.front()["disk_bytes"]);
    int next_row = 0;
    for (int i = 0; i < kShards; ++i) {
        const json& part = parts[static_cast<std::size_t>(i) + 1];
        INFO(part.dump());
        CHECK(part["first_row"] == next_row);
        next_row += part["rows"].get<int>();
        const auto before = bytes_below(work);
        place.run_to(0, {"--stage", "tiles", "--shard", std::to_string(i) + "/3"});
        CHECK(part["tiles"] == place.done({i, kShards}));
        CHECK(part["disk_bytes"] == bytes_below(work) - before);
    }
    CHECK(next_row == 300);
    // More shards than pieces of 64 rows: some have nothing to do.
    const json many =
        json::parse(plan(place, {"--shards", "9", "--json", "--no-time"}).out)["parts"];
    CHECK(std::count_if(many.begin(), many.end(), [](const json& part) {
              return part.value("tiles", -1) == 0 && part["memory_bytes"] == 0;
          }) == 4);
}

TEST_CASE("a plan is the same at each call but for the time, which stands apart")
{
    const RunPlace place;
    const Outcome without = plan(place, {"--shards", "2", "--json", "--no-time"});
    CHECK(plan(place, {"--shards", "2", "--json", "--no-time"}).out == without.out);
    json with = json::parse(plan(place, {"--shards", "2", "--json"}).out);
    const json time = with["time"];
    CHECK(time["measured_ns_per_px"]["match"] > 0);
    CHECK(time["all_s"] >= time["tiles_s"]);
    CHECK(time["parts_s"].size() == 4);
    with.erase("time");
    CHECK(with == json::parse(without.out));
    const Outcome words = plan(place, {"--shards", "2"});
    CHECK_THAT(words.out, Contains("time      about ") && Contains("tiles 1/2") &&
                              Contains("side by side, on machines like this one: about "));
    CHECK_THAT(plan(place, {"--no-time"}).out, !Contains("time"));
    CHECK(run_hsgm({"plan", place / "run.yaml", "--shards", "0"}).code == 2);
}
