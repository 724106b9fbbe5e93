#include "tests/catch.h"

#include "tests/seam/child.h"
#include "tests/seam/run_files.h"

#include "io/geotiff_writer.h"
#include "pipeline/stages/match_stage.h"

#include <cstdio>
#include <cstdlib>
#include <string>

using namespace hsgm;
using namespace hsgm::seam;
using matcher::Mode;

namespace {

constexpr std::int64_t kMiB = 1 << 20;

// The scene side by side and below itself, until the raster is full: a large image at the
// price of a small one. Written in rows of blocks.
void write_repeated(const tiling::Image<std::uint16_t>& scene, tiling::Size size,
                    const std::filesystem::path& path)
{
    io::RasterOptions options;
    options.nodata = 0;
    options.creation_options = {"COMPRESS=NONE"};
    io::GeoTiffWriter writer(path, size, io::PixelType::uint8, options);
    const int block = writer.block_size().rows;
    for (int top = 0; top < size.rows; top += block) {
        tiling::Image<std::uint8_t> strip({std::min(block, size.rows - top), size.cols});
        for (int row = 0; row < strip.rows(); ++row) {
            const std::uint16_t* from = scene.row((top + row) % scene.rows());
            for (int col = 0; col < size.cols; ++col) {
                const std::uint16_t pixel = from[col % scene.cols()];
                strip(row, col) =
                    matcher::is_valid(pixel) ? static_cast<std::uint8_t>(pixel) : 0;
            }
        }
        writer.write({top, 0, strip.rows(), size.cols}, strip);
    }
    writer.finish();
}

pipeline::Job write_large_pair(tiling::Size size, const std::filesystem::path& folder)
{
    synth::Scene scene = city({1000, 1000}, 5);
    scene.city->height_max_px = 12;
    const StereoPair pair = render(scene);
    pipeline::Job job;
    job.left.path = (folder / "left.tif").string();
    job.right.path = (folder / "right.tif").string();
    job.disparity = pair.asked;
    write_repeated(pair.left, size, job.left.path);
    write_repeated(pair.right, size, job.right.path);
    job.outputs.disparity = folder / "disparity.tif";
    job.outputs.confidence = folder / "disparity.confidence.tif";
    job.outputs.reasons = folder / "disparity.reasons.tif";
    return job;
}

// The job as a user would run it, in a process of its own.
ChildResult run_program(const pipeline::Job& job)
{
    std::vector<std::string> command{HSGM_PROGRAM,
                                     "--log-level",
                                     "warn",
                                     "match",
                                     job.left.path,
                                     job.right.path,
                                     "-o",
                                     job.outputs.disparity.string(),
                                     "--disparity=" + std::to_string(job.disparity.min) + "," +
                                         std::to_string(job.disparity.max),
                                     "--threads",
                                     std::to_string(job.run.threads),
                                     "--set",
                                     "matcher.mode=" + std::string(name(job.matcher.mode)),
                                     "--set",
                                     "matcher.cost=" + std::string(name(job.matcher.cost))};
    if (job.run.tile_size_px) {
        command.insert(command.end(), {"--tile-size", std::to_string(*job.run.tile_size_px)});
    }
    if (job.run.memory_bytes) {
        command.insert(command.end(), {"--memory", std::to_string(*job.run.memory_bytes)});
    }
    return run_child(command);
}

// Peak memory of the run against the plan's estimate, which it returns as a multiple of it.
double check_estimate(const pipeline::Job& job, const char* what)
{
    const auto budget = pipeline::plan_job(job).budget;
    const ChildResult result = run_program(job);
    std::printf("%-44s %4d px, %d threads: %5lld of %5lld MiB (prepare %lld, coarse %lld, "
                "tiles %lld, refine %lld), %.1f s\n",
                what, budget.tile_size_px, budget.threads,
                static_cast<long long>(result.peak_bytes / kMiB),
                static_cast<long long>(budget.estimate_bytes / kMiB),
                static_cast<long long>(budget.prepare_bytes / kMiB),
                static_cast<long long>(budget.coarse_bytes / kMiB),
                static_cast<long long>(budget.tiles_bytes / kMiB),
                static_cast<long long>(budget.refine_bytes / kMiB), result.seconds);
    std::fflush(stdout);
    INFO(what << ", tiles of " << budget.tile_size_px << " px, threads " << budget.threads);
    CHECK(result.exit_code == 0);
    CHECK(result.peak_bytes <= budget.estimate_bytes);
    return static_cast<double>(budget.estimate_bytes) / static_cast<double>(result.peak_bytes);
}

} // namespace

TEST_CASE("a run takes no more memory than its plan says")
{
    const TemporaryFolder folder;
    pipeline::Job job = write_large_pair({1400, 2000}, folder.path());
    for (const int threads : {1, 2}) {
        job.run.threads = threads;
        for (const int tile : {64, 256, 1024, 0}) {
            job.run.tile_size_px = tile;
            check_estimate(job, "hsgm");
        }
    }
    job.matcher.mode = Mode::sgm;
    check_estimate(job, "sgm");
    job.matcher.mode = Mode::local;
    job.run.tile_size_px = 512;
    check_estimate(job, "local");
    job.matcher.mode = Mode::hsgm_paper;
    job.matcher.cost = matcher::Cost::hmi;
    check_estimate(job, "hsgm-paper with hmi");
    job.matcher = {};
    job.disparity = {-400, 623};
    check_estimate(job, "hsgm, 1024 disparities");
    job.run.tile_size_px = 0;
    check_estimate(job, "hsgm, 1024 disparities, untiled");
}

TEST_CASE("the plan of a large run is not far above what the run takes")
{
    const TemporaryFolder folder;
    pipeline::Job job = write_large_pair({4000, 5000}, folder.path());
    job.disparity = {-40, 87};
    for (const int threads : {1, 2}) {
        for (const std::int64_t memory : {std::int64_t{512} * kMiB, 4096 * kMiB}) {
            job.run.threads = threads;
            job.run.memory_bytes = memory;
            CHECK(check_estimate(job, "hsgm, 128 disparities") < 1.4);
        }
    }
}

TEST_CASE("images several times larger than the memory allowed are matched within it")
{
    const TemporaryFolder folder;
    pipeline::Job job = write_large_pair({9000, 12000}, folder.path());
    job.run.threads = 2;
    // Two images of 103 MiB, results of 412, 103 and 206 MiB, scratch files of 1.5 GiB.
    job.run.memory_bytes = 256 * kMiB;
    const auto budget = pipeline::plan_job(job).budget;
    CHECK(budget.scratch_disk_bytes > 5 * 256 * kMiB);
    const ChildResult result = run_program(job);
    std::printf("12000 x 9000 px, %d disparities, tiles of %d px: %lld of 256 MiB, %.0f s\n",
                job.disparity.count(), budget.tile_size_px,
                static_cast<long long>(result.peak_bytes / kMiB), result.seconds);
    CHECK(result.exit_code == 0);
    CHECK(result.peak_bytes <= 256 * kMiB);
}
