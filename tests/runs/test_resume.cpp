#include "tests/runs/run_place.h"

#include "tests/catch.h"

#include <algorithm>
#include <csignal>

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;
using ledger::TileState;

namespace {

// Names in the result folder that a finished run must not have.
std::vector<std::string> leftovers(const RunPlace& place)
{
    std::vector<std::string> found;
    for (const std::string& name : names_in(snapshot(place.result()))) {
        if (name.starts_with(".") || name.starts_with("work")) {
            found.push_back(name);
        }
    }
    return found;
}

} // namespace

TEST_CASE("a killed run resumes to the same bits and repeats only what was not done")
{
    const RunPlace place = slow_place();
    const int done = place.run_and_kill(10);
    const auto before = place.tiles();
    REQUIRE(done < static_cast<int>(before.size()));
    const Outcome resumed = place.run_to(0, {"--resume"});
    CHECK_THAT(resumed.err, Contains("resuming: " + std::to_string(done) + " tiles are done"));
    CHECK((place.rasters() == place.undisturbed()));
    CHECK(leftovers(place).empty());
    const ledger::Contents after = place.ledger();
    const auto ended_well = std::count_if(
        after.attempts.begin(), after.attempts.end(), [](const ledger::AttemptRow& attempt) {
            return attempt.stage == pipeline::kMatchStage && attempt.outcome == "done";
        });
    CHECK(ended_well == static_cast<int>(before.size()));
    CHECK(place.done() == static_cast<int>(before.size()));
    CHECK(after.owners.size() == 2);
}

TEST_CASE("a killed run resumes with other tiles, threads and memory to the same bits")
{
    const RunPlace place = slow_place();
    const int first = place.run_and_kill(8);
    const int second =
        place.run_and_kill(first + 3, {"--resume", "--tile-size", "100", "--threads", "1"});
    CHECK(second > first);
    place.run_to(0, {"--resume", "--tile-size", "256", "--memory", "512MiB"});
    CHECK((place.rasters() == place.undisturbed()));
}

TEST_CASE("a run killed while it writes its outputs resumes without a trace")
{
    const RunPlace place;
    {
        RunningProgram program(place.command());
        REQUIRE(comes_true([&] {
            const auto names = place.has_begun() ? names_in(snapshot(place.result()))
                                                 : std::vector<std::string>{};
            return program.has_ended() ||
                   std::any_of(names.begin(), names.end(), [](const std::string& name) {
                       return name.starts_with(".disparity.part-");
                   });
        }));
        program.signal(SIGKILL);
    }
    place.run_to(0, {"--resume"});
    CHECK((place.rasters() == place.undisturbed()));
    CHECK(leftovers(place).empty());
}

TEST_CASE("a finished run that is resumed is left alone")
{
    const RunPlace place({100, 100});
    place.run_to(0, {"--resume"}); // nothing to resume: an ordinary run
    const Snapshot before = snapshot(place.result());
    const Outcome again = place.run_to(0, {"--resume"});
    CHECK_THAT(again.err, Contains("everything is done already"));
    CHECK((rasters_in(place.result()) == place.rasters()));
    CHECK(snapshot(place.result()).at("disparity.tif") == before.at("disparity.tif"));
}

TEST_CASE("a run that is interrupted keeps what is done, and resumes")
{
    for (const int number : {SIGINT, SIGTERM}) {
        const RunPlace place = slow_place();
        RunningProgram program(place.command());
        REQUIRE(comes_true([&] { return program.has_ended() || place.done() > 0; }));
        program.signal(number);
        const Outcome outcome = program.wait();
        CHECK(outcome.code == 130);
        CHECK_THAT(outcome.err, Contains("error: interrupted") && Contains("--resume"));
        CHECK(place.done() > 0);
        for (const ledger::TileRow& row : place.tiles()) {
            CHECK(row.state != TileState::running);
            CHECK(row.deaths == 0);
        }
        place.run_to(0, {"--resume"});
        CHECK((place.rasters() == place.undisturbed()));
    }
}

// What solving the image in one piece took, the last time.
double seconds_of_coarse(const RunPlace& place)
{
    double seconds = 0;
    for (const ledger::AttemptRow& attempt : place.ledger().attempts) {
        seconds = attempt.stage == "coarse" ? attempt.seconds : seconds;
    }
    return seconds;
}

TEST_CASE("mode sgm can be interrupted while it solves the image in one piece")
{
    const RunPlace place({700, 900});
    const std::vector<std::string> sgm{"--set", "matcher.mode=sgm",
                                       "--set", "matcher.paths=16",
                                       "--set", "matcher.disparity=[0,255]"};
    place.run_to(0, sgm);
    const double whole_s = seconds_of_coarse(place);
    RunningProgram program(place.command(sgm));
    REQUIRE(comes_true([&] {
        const auto rows = place.ledger().tiles;
        return program.has_ended() ||
               std::any_of(rows.begin(), rows.end(), [](const ledger::TileRow& row) {
                   return row.stage == "coarse" && row.state == TileState::running;
               });
    }));
    program.signal(SIGINT);
    CHECK(program.wait().code == 130);
    CHECK(seconds_of_coarse(place) < 0.6 * whole_s);
    CHECK(place.done() == 0);
}

TEST_CASE("a second signal ends a run at once")
{
    const RunPlace place = slow_place();
    RunningProgram program(place.command());
    REQUIRE(comes_true([&] { return program.has_ended() || place.done() > 0; }));
    program.signal(SIGTERM);
    program.signal(SIGTERM);
    const int code = program.wait().code;
    CHECK((code == -SIGTERM || code == 130)); // or it was through already
    place.run_to(0, {"--resume"});
    CHECK((place.rasters() == place.undisturbed()));
}
