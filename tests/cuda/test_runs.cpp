#include "tests/catch.h"

#include "pipeline/stages/match_stage.h"
#include "tests/cuda/shared_out.h"
#include "tests/device_stand_in/control.h"
#include "tests/end_to_end/program.h"
#include "tests/seam/run_files.h"

#include "matcher/profile.h"

#include <filesystem>

using namespace hsgm;
using namespace hsgm::seam;
using Catch::Matchers::Contains;

namespace {

pipeline::Job town_job(const TemporaryFolder& folder,
                       matcher::Profile profile = matcher::Profile::satellite)
{
    pipeline::Job job = write_pair(render(city({150, 170}, 5)), Storage::uint16, folder.path());
    job.matcher = matcher::options_of(profile);
    job.matcher.window_px = 32;
    job.run.tile_size_px = 64;
    job.run.threads = 2;
    return job;
}

tests::Outcome run_with_device(const std::vector<std::string>& arguments)
{
    std::vector<std::string> command{HSGM_STAND_IN_PROGRAM};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return tests::run_program(command);
}

} // namespace

TEST_CASE("a run whose tiles are shared out to processor and device gives the same files")
{
    const TemporaryFolder folder;
    const auto profile = GENERATE(matcher::Profile::satellite, matcher::Profile::close);
    INFO(name(profile));
    pipeline::Job job = town_job(folder, profile);
    const auto files_of = [&](const std::string& device, cuda_test::SharedOut& shared) {
        const auto out = folder.path() / device;
        std::filesystem::create_directory(out);
        set_outputs(job, out);
        job.run.device = device;
        pipeline::RunManner manner;
        manner.adapt_worker = shared.adapter();
        const auto result = pipeline::run_job(pipeline::plan_job(job), manner, {});
        CHECK(result.failed.empty());
        return tests::snapshot(out.string());
    };
    cuda_test::SharedOut on_processor;
    const auto expected = files_of("cpu", on_processor);
    CHECK(expected.size() == 5);
    CHECK(on_processor.tiles("cpu") == 9);
    CHECK(on_processor.tiles("cuda") == 0);

    // Both kinds take tiles, and what a device takes it matches: nothing is left to the
    // processor in silence.
    const auto before = stand_in::launches();
    cuda_test::SharedOut shared;
    CHECK((files_of("auto", shared) == expected));
    CHECK(shared.tiles("cpu") >= 2);
    CHECK(shared.tiles("cuda") >= 2);
    CHECK(shared.tiles("cpu") + shared.tiles("cuda") == 9);
    const auto launches = stand_in::launches() - before;
    CHECK(launches >= shared.tiles("cuda"));
    CHECK(launches % shared.tiles("cuda") == 0);

    cuda_test::SharedOut on_device;
    CHECK((files_of("cuda", on_device) == expected));
    CHECK(on_device.tiles("cuda") == 9);
}

TEST_CASE("a run that loses its device half way gives the same files")
{
    const TemporaryFolder folder;
    pipeline::Job job = town_job(folder);
    job.run.device = "cpu";
    const auto on_processor = run(job);
    job.run.device = "cuda";
    job.run.order = tiling::TileOrder::shuffled;
    stand_in::set_faults({-1, 40});
    CHECK(difference(on_processor, run(job)) == "");
    stand_in::reset();
}

TEST_CASE("the program matches on the device that is asked for")
{
    const TemporaryFolder folder;
    const pipeline::Job job = town_job(folder);
    std::vector<StoredRaster> results[2];
    for (const int device : {0, 1}) {
        const auto output = folder.path() / (device == 0 ? "cpu.tif" : "cuda.tif");
        const auto outcome = run_with_device(
            {"match", job.left.path, job.right.path, "-o", output.string(), "--disparity",
             std::to_string(job.disparity.min) + "," + std::to_string(job.disparity.max),
             "--tile-size", "64", "--set", "matcher.window=32", "--device",
             device == 0 ? "cpu" : "cuda:0"});
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        if (device == 1) {
            CHECK_THAT(outcome.err, Contains("cuda:0 (stand-in 0"));
        }
        results[device] = stored_rasters({output});
    }
    results[1][0].name = results[0][0].name;
    CHECK(difference(results[0], results[1]) == "");
}

TEST_CASE("the program tells of its devices, and refuses those that are not there")
{
    const auto info = run_with_device({"info"});
    CHECK(info.code == 0);
    CHECK_THAT(info.out, Contains("cuda:0 stand-in 0, compute capability 9.0"));
    const auto refused = run_with_device({"match", "left.tif", "right.tif", "-o", "d.tif",
                                          "--disparity", "0,15", "--device", "cuda:7"});
    CHECK(refused.code == 4);
    CHECK_THAT(refused.err, Contains("'run.device' is 'cuda:7'") && Contains("count from 0"));
}

TEST_CASE("a benchmark measures the device beside the processor")
{
    const auto outcome = run_with_device({"bench",
                                          "--device",
                                          "cuda",
                                          "--side",
                                          "128",
                                          "--disparities",
                                          "16",
                                          "--cost",
                                          "census5x5,pairs_bt",
                                          "--instructions",
                                          "auto",
                                          "--threads",
                                          "1",
                                          "--peers",
                                          "none",
                                          "--repeats",
                                          "1",
                                          "--set",
                                          "matcher.levels=2",
                                          "--set",
                                          "matcher.window=32"});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK_THAT(outcome.out, Contains("hsgm census5x5, cuda:0, not pruned") &&
                                Contains("hsgm pairs_bt, cuda:0") &&
                                Contains("stand-in 0, windows alone"));
}
