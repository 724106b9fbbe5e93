#include "io/error.h"
#include "pipeline/stages/match_stage.h"
#include "tests/end_to_end/pairs.h"
#include "tests/end_to_end/program.h"
#include "tests/faults/faulty_filesystem.h"

#include "tests/catch.h"

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;

namespace {

pipeline::Job job_in(const TemporaryFolder& folder)
{
    pipeline::Job job;
    job.left.path = folder / "left.tif";
    job.right.path = folder / "right.tif";
    job.disparity = {0, 10};
    job.run.threads = 1;
    job.outputs.disparity = folder / "d.tif";
    job.outputs.confidence = folder / "d.confidence.tif";
    job.outputs.reasons = folder / "d.reasons.tif";
    return job;
}

void carry_out(const pipeline::Job& job)
{
    pipeline::run_job(pipeline::plan_job(job), [](int, int) {});
}

void make_tiled_pair(const TemporaryFolder& folder)
{
    for (const std::string name : {"left.tif", "right.tif"}) {
        make_raster(folder / name, GDT_Byte, {60, 90}, {noise({60, 90})}, {},
                    {"TILED=YES", "BLOCKXSIZE=32", "BLOCKYSIZE=32"});
    }
}

// Faults numbered from 1 to `count`, at most about twenty of them.
std::vector<int> some_of(int count)
{
    std::vector<int> numbers;
    for (int n = 1; n <= count; n += std::max(1, count / 20)) {
        numbers.push_back(n);
    }
    return numbers;
}

} // namespace

TEST_CASE("whichever read of a source fails, the result is right or refused, never damaged")
{
    const TemporaryFolder folder;
    make_tiled_pair(folder);
    carry_out(job_in(folder));
    const Snapshot before = snapshot(folder.path().string());
    const bool left = GENERATE(true, false);
    pipeline::Job job = job_in(folder);
    std::string& faulty_path = left ? job.left.path : job.right.path;
    faulty_path = FaultyFilesystem::over(faulty_path);
    int reads = 0;
    {
        const FaultyFilesystem healthy;
        carry_out(job);
        reads = healthy.counts().reads;
    }
    REQUIRE(reads > 5);
    int refused = 0;
    for (const int n : some_of(reads)) {
        INFO("read " << n << " of " << reads);
        const FaultyFilesystem faulty(FaultPlan{.fail_read = n});
        try {
            carry_out(job);
        } catch (const io::InputError& error) {
            ++refused;
            CHECK_THAT(error.what(), Contains(faulty_path));
        }
        CHECK((snapshot(folder.path().string()) == before));
    }
    CHECK(refused > 0);
}

TEST_CASE("whichever write of one output fails, all earlier outputs stay")
{
    const TemporaryFolder folder;
    make_tiled_pair(folder);
    carry_out(job_in(folder));
    const Snapshot before = snapshot(folder.path().string());
    pipeline::Job job = job_in(folder);
    job.matcher.median = 1; // another result, so that a replaced file shows
    job.disparity = {0, 9};
    // Scratch files lie beside the disparities, and are no business of GDAL's.
    const auto faulty_output =
        GENERATE(&pipeline::OutputPaths::confidence, &pipeline::OutputPaths::reasons);
    std::filesystem::path& path = job.outputs.*faulty_output;
    path = FaultyFilesystem::over(path.string());
    FaultCounts counts;
    {
        const TemporaryFolder elsewhere;
        make_tiled_pair(elsewhere);
        pipeline::Job healthy_job = job_in(elsewhere);
        std::filesystem::path& healthy_path = healthy_job.outputs.*faulty_output;
        healthy_path = FaultyFilesystem::over(healthy_path.string());
        const FaultyFilesystem healthy;
        carry_out(healthy_job);
        counts = healthy.counts();
    }
    REQUIRE(counts.writes > 0);
    std::vector<FaultPlan> plans{{.fail_close = counts.closes}};
    for (const int n : some_of(counts.writes)) {
        plans.push_back({.fail_write = n});
    }
    for (const FaultPlan& plan : plans) {
        INFO("write " << plan.fail_write << ", close " << plan.fail_close);
        const FaultyFilesystem faulty(plan);
        CHECK_THROWS_AS(carry_out(job), io::StorageError);
        CHECK((snapshot(folder.path().string()) == before));
    }
}
