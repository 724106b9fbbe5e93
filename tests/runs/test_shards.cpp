#include "tests/runs/run_place.h"

#include "tests/catch.h"

#include <filesystem>
#include <memory>

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;

namespace {

std::string shard(int index, int count)
{
    return std::to_string(index) + "/" + std::to_string(count);
}

} // namespace

TEST_CASE("any number of shards gives the same bits, stage by stage")
{
    const RunPlace place;
    for (const int count : {1, 3, 7}) {
        INFO(count << " shards");
        place.run_to(0, {"--stage", "coarse"});
        for (int i = count - 1; i >= 0; --i) {
            place.run_to(0, {"--stage", "tiles", "--shard", shard(i, count), "--tile-size",
                             i % 2 == 0 ? "64" : "100"});
        }
        place.run_to(0, {"--stage", "assemble"});
        CHECK((place.rasters() == place.undisturbed()));
        CHECK_FALSE(std::filesystem::exists(place.result() + "/work"));
    }
}

TEST_CASE("shards that run at once prepare together, and the last one assembles")
{
    const RunPlace place;
    std::vector<std::unique_ptr<RunningProgram>> programs;
    for (int i = 0; i < 3; ++i) {
        programs.push_back(
            std::make_unique<RunningProgram>(place.command({"--shard", shard(i, 3)})));
    }
    for (const auto& program : programs) {
        const Outcome outcome = program->wait();
        INFO(outcome.err);
        CHECK(outcome.code == 0);
    }
    CHECK((place.rasters() == place.undisturbed()));
}

TEST_CASE("the shard comes from the job array of Slurm or Kubernetes")
{
    const RunPlace place;
    ::setenv("SLURM_ARRAY_TASK_COUNT", "2", 1);
    ::setenv("SLURM_ARRAY_TASK_MIN", "0", 1);
    ::setenv("SLURM_ARRAY_TASK_MAX", "1", 1);
    ::setenv("SLURM_ARRAY_TASK_ID", "0", 1);
    place.run_to(0, {"--shard", "auto"});
    for (const char* name : {"COUNT", "MIN", "MAX", "ID"}) {
        ::unsetenv((std::string("SLURM_ARRAY_TASK_") + name).c_str());
    }
    CHECK(place.rasters().empty());
    ::setenv("JOB_COMPLETION_INDEX", "1", 1);
    const Outcome refused = place.run_to(2, {"--shard", "auto"});
    CHECK_THAT(refused.err, Contains("--shard auto/N"));
    place.run_to(0, {"--shard", "auto/2"});
    ::unsetenv("JOB_COMPLETION_INDEX");
    CHECK((place.rasters() == place.undisturbed()));
}

TEST_CASE("an unfinished sharded run is finished by a run without shards")
{
    const RunPlace place;
    place.run_to(0, {"--shard", "1/3"});
    place.run_to(0, {"--resume"});
    CHECK((place.rasters() == place.undisturbed()));
}

TEST_CASE("stages out of order and shards that do not fit are refused")
{
    const RunPlace place;
    const auto refused = [&](const std::vector<std::string>& options,
                             const std::vector<std::string>& words) {
        const Outcome outcome = place.run_to(2, options);
        for (const std::string& word : words) {
            CHECK_THAT(outcome.err, Contains(word));
        }
    };
    refused({"--stage", "tiles", "--shard", "0/2"},
            {"coarse stage", "is not there", "--stage coarse"});
    refused({"--stage", "tiles"}, {"--shard I/N"});
    refused({"--stage", "coarse", "--shard", "0/2"}, {"leave out --shard"});
    refused({"--shard", "2/2"}, {"shard 2 of 2", "from 0 to N - 1"});
    refused({"--shard", "2"}, {"--shard must be I/N", "'2'"});
    refused({"--shard", "a/b"}, {"--shard must be I/N"});
    refused({"--shard", "0/2", "--restart"}, {"--stage coarse alone"});
    refused({"--take-over"}, {"add --shard"});
    place.run_to(0, {"--stage", "coarse"});
    refused({"--stage", "tiles", "--shard", "0/2", "--set", "matcher.p1=10"},
            {"matcher.p1: 24 before, 10 now"});
    place.run_to(0, {"--stage", "tiles", "--shard", "0/2"});
    refused({"--stage", "tiles", "--shard", "1/3"}, {"begun with 2 shards, not 3"});
    refused({"--stage", "assemble"}, {"cannot be assembled", "shard 1/2 has not begun"});
}
