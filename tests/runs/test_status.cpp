#include "tests/runs/run_place.h"

#include "tests/catch.h"

#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <sstream>

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

json status(const RunPlace& place)
{
    const Outcome outcome = run_hsgm({"status", place.result(), "--json"});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    return json::parse(outcome.out);
}

std::vector<json> lines_of(const std::string& text)
{
    std::vector<json> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        INFO(line);
        lines.push_back(json::parse(line));
    }
    return lines;
}

int count_events(const std::vector<json>& lines, const std::string& event)
{
    return static_cast<int>(std::count_if(lines.begin(), lines.end(), [&](const json& line) {
        return line.value("event", "") == event;
    }));
}

} // namespace

TEST_CASE("status tells of a run at work, of a stopped one and of a finished one")
{
    const RunPlace place = slow_place();
    {
        RunningProgram program(place.command());
        REQUIRE(comes_true([&] { return program.has_ended() || place.done() > 5; }));
        program.signal(SIGSTOP); // stays where it is
        const json now = status(place);
        CHECK(now["state"] == "at work");
        CHECK(now["tiles"]["all"] == 130);
        CHECK(now["tiles"]["done"] > 5);
        CHECK(now["tiles"]["done"] < 130);
        CHECK(now["pixels_per_second"] > 0);
        CHECK(now["seconds_left"] >= 0);
        const Outcome words = run_hsgm({"status", place.result()});
        CHECK_THAT(words.out, Contains("state     at work") && Contains("of 130 done"));
        program.signal(SIGKILL);
        program.wait();
    }
    const json stopped = status(place);
    CHECK(stopped["state"] == "stopped");
    CHECK(stopped["tiles"]["running"] == 0);
    CHECK(stopped["seconds_left"].is_null());
    place.run_to(0, {"--resume"});
    const json finished = status(place);
    CHECK(finished["state"] == "finished");
    CHECK(finished["tiles"]["done"] == 130);
}

TEST_CASE("status of a folder without a run is refused, and writes nothing")
{
    const TemporaryFolder folder;
    const Outcome outcome = run_hsgm({"status", folder.path()});
    CHECK(outcome.code == 3);
    CHECK_THAT(outcome.err, Contains("holds no run"));
    CHECK(snapshot(folder.path()).empty());
}

TEST_CASE("a run's log has an object for every tile and stage")
{
    const RunPlace place({200, 200});
    place.run_to(0);
    const auto lines = lines_of(io::samples::bytes_of_file(place.result() + "/logs/run.jsonl"));
    CHECK(count_events(lines, "begin") == 1);
    CHECK(count_events(lines, "end") == 1);
    CHECK(count_events(lines, "tile") == 16);
    for (const char* stage : {"prepare", "coarse", "refine", "checksums"}) {
        INFO(stage);
        CHECK(std::count_if(lines.begin(), lines.end(), [&](const json& line) {
                  return line.value("stage", "") == stage && line["seconds"] > 0;
              }) == 1);
    }
    for (const json& line : lines) {
        CHECK(line["time"].get<std::string>().ends_with("Z"));
        if (line.value("event", "") == "tile") {
            CHECK(line["state"] == "done");
            CHECK(line["seconds"] > 0);
            CHECK_FALSE(line["worker"].get<std::string>().empty());
        }
    }
}

TEST_CASE("with --log-json everything on standard error is an object a line")
{
    const RunPlace place({200, 200});
    const Outcome done = run_program([&] {
        auto words = place.command();
        words.insert(words.begin() + 1, "--log-json");
        return words;
    }());
    CHECK(done.code == 0);
    const auto lines = lines_of(done.err);
    CHECK(count_events(lines, "tile") == 16);
    CHECK(std::any_of(lines.begin(), lines.end(), [](const json& line) {
        return line.value("level", "") == "info" && line.contains("message");
    }));
    const Outcome refused = run_hsgm({"--log-json", "run", place / "none.yaml"});
    CHECK(refused.code == 2);
    const auto errors = lines_of(refused.err);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0]["level"] == "error");
}

TEST_CASE("run.json tells what defines the result, how it came about and its checksums")
{
    const RunPlace place = slow_place();
    place.run_and_kill(5);
    place.run_to(0, {"--resume"});
    const json record = json::parse(io::samples::bytes_of_file(place.result() + "/run.json"));
    CHECK(record["defines"]["matcher.p2"] == "192");
    CHECK_FALSE(record["defines"].contains("run.tile_size"));
    CHECK_THAT(record["defines"]["left image pixels"].get<std::string>(),
               Contains("checksum "));
    CHECK(record["tiles"]["done"] == 130);
    CHECK(record["tiles"]["failed"] == 0);
    CHECK(record["processes"].size() >= 4); // two attempts at two ledgers and more
    CHECK(record["result"]["pixels"] == 600 * 800);
    CHECK(record["seams"]["window"]["cell_px"] == 64);
    for (const auto& [name, output] : record["outputs"].items()) {
        const std::string path = place.result() + "/" + name;
        INFO(name);
        CHECK(output["bytes"] == std::filesystem::file_size(path));
        const Outcome sum = run_program({"sha256sum", path});
        CHECK_THAT(sum.out, Contains(output["sha256"].get<std::string>()));
    }
}

TEST_CASE("the report shows completeness, seams, time and workers, and can be made again")
{
    const RunPlace place({200, 200});
    place.run_to(0);
    const std::string path = place.result() + "/report.html";
    const std::string report = io::samples::bytes_of_file(path);
    for (const char* part : {"completeness", "<h2>Seams</h2>", "<h2>Time</h2>",
                             "<h2>Reasons</h2>", "cpu 0", "<svg", "SHA-256"}) {
        CHECK_THAT(report, Contains(part));
    }
    CHECK_THAT(report, Contains("class='done'><title>") && Contains("class='stage'><title>"));
    std::filesystem::remove(path);
    CHECK(run_hsgm({"report", place.result()}).code == 0);
    CHECK(io::samples::bytes_of_file(path) == report);
}
