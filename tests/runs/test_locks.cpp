#include "tests/runs/run_place.h"

#include "tests/catch.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;

namespace {

// When a run is stopped: anywhere, or in the midst of writing to its ledger, which is then
// locked for everybody.
enum class Moment { any, commit };

// A run at work on its tiles, stopped so that it stays there.
class Stopped {
public:
    explicit Stopped(const RunPlace& place, const std::vector<std::string>& more = {},
                     Moment moment = Moment::any)
        : program_(place.command(more))
    {
        REQUIRE(comes_true([&] { return program_.has_ended() || place.done() > 0; }));
        const std::string journal = place.result() + "/ledger/tiles-0-of-1.sqlite-journal";
        REQUIRE(comes_true([&] {
            program_.signal(SIGSTOP);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            const bool there =
                moment == Moment::any ||
                (std::filesystem::exists(journal) && std::filesystem::file_size(journal) > 0);
            program_.signal(there ? SIGSTOP : SIGCONT);
            return there;
        }));
    }
    Outcome go_on()
    {
        program_.signal(SIGCONT);
        return program_.wait();
    }

private:
    RunningProgram program_;
};

} // namespace

TEST_CASE("a second run in the same folder is refused while the first one works")
{
    const RunPlace place = slow_place();
    Stopped first(place);
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"--resume"}, {"--restart"}}) {
        const Outcome second = place.run_to(6, more);
        CHECK_THAT(second.err, Contains("process ") && Contains("is at work on") &&
                                   Contains("name another output folder"));
    }
    CHECK(first.go_on().code == 0);
    CHECK((place.rasters() == place.undisturbed()));
}

TEST_CASE("a process that takes over leaves the one before it without effect")
{
    const RunPlace place = slow_place();
    const std::vector<std::string> shard{"--shard", "0/1"};
    Stopped first(place, shard);
    const Outcome second = place.run_to(0, {"--shard", "0/1", "--resume", "--take-over"});
    CHECK_THAT(second.err, Contains("taking over from process"));
    const Snapshot rasters = place.rasters();
    CHECK((rasters == place.undisturbed()));
    const Outcome fenced = first.go_on();
    CHECK(fenced.code == 6);
    CHECK((place.rasters() == rasters));
}

TEST_CASE("a process that was taken over in mid-run does no harm to the one after it")
{
    const RunPlace place = slow_place();
    Stopped first(place, {"--shard", "0/1"});
    {
        // The next one begins, and is killed; then the first one wakes up again.
        RunningProgram second(place.command({"--shard", "0/1", "--resume", "--take-over"}));
        const int before = place.done();
        REQUIRE(comes_true([&] { return second.has_ended() || place.done() > before + 2; }));
        second.signal(SIGKILL);
    }
    CHECK(first.go_on().code == 6);
    CHECK_THAT(place.ledger().owners.back().part,
               Catch::Matchers::Predicate<int>([](int part) { return part == 1; }));
    place.run_to(0, {"--shard", "0/1", "--resume"});
    CHECK((place.rasters() == place.undisturbed()));
}

TEST_CASE("a requeued job takes over from one that is frozen in the midst of a commit")
{
    // Many tiles, so that a commit is caught long before the last one.
    const RunPlace place({1500, 1600}, 255);
    ::setenv("SLURM_JOB_ID", "73", 1);
    Stopped first(place, {"--shard", "0/1"}, Moment::commit);
    const auto start = std::chrono::steady_clock::now();
    const Outcome status = run_hsgm({"status", place.result()});
    CHECK_THAT(status.out, Contains("state     at work"));
    ::setenv("SLURM_RESTART_COUNT", "1", 1);
    place.run_to(0, {"--shard", "0/1"});
    ::unsetenv("SLURM_RESTART_COUNT");
    ::unsetenv("SLURM_JOB_ID");
    // Nobody waited for what does not come.
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(120));
    const Snapshot rasters = place.rasters();
    CHECK((rasters == place.undisturbed()));
    const auto owners = place.ledger().owners;
    REQUIRE(owners.size() == 2);
    CHECK(owners.back().part == 1);
    CHECK(first.go_on().code == 6);
    CHECK((place.rasters() == rasters));
    CHECK(place.ledger().owners.size() == 2);
}

TEST_CASE("a requeued job takes over from its earlier self, and no other job does")
{
    const RunPlace place = slow_place();
    ::setenv("SLURM_JOB_ID", "71", 1);
    Stopped first(place, {"--shard", "0/1"});
    place.run_to(6, {"--shard", "0/1", "--resume"});
    ::setenv("SLURM_RESTART_COUNT", "1", 1);
    ::setenv("SLURM_JOB_ID", "72", 1);
    place.run_to(6, {"--shard", "0/1"});
    ::setenv("SLURM_JOB_ID", "71", 1);
    place.run_to(0, {"--shard", "0/1"}); // --resume goes without saying
    ::unsetenv("SLURM_JOB_ID");
    ::unsetenv("SLURM_RESTART_COUNT");
    CHECK(first.go_on().code == 6);
    CHECK((place.rasters() == place.undisturbed()));
}
