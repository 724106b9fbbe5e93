#include "pipeline/bench/file_match.h"

#include "io/geotiff_writer.h"
#include "pipeline/stages/match_stage.h"

#include <algorithm>
#include <chrono>

namespace hsgm::bench {

namespace {

void write_image(const std::filesystem::path& path, const tiling::Image<std::uint16_t>& image)
{
    tiling::Image<std::uint8_t> bytes(image.size());
    const auto pixels = image.pixels();
    std::transform(pixels.begin(), pixels.end(), bytes.data(),
                   [](std::uint16_t v) { return static_cast<std::uint8_t>(v); });
    io::RasterOptions options;
    options.nodata = 0;
    io::GeoTiffWriter writer(path.string(), image.size(), io::PixelType::uint8, options);
    writer.write<std::uint8_t>(rect_of(image.size()), bytes.view());
    writer.finish();
}

} // namespace

void write_pair(const BenchPair& pair, const std::filesystem::path& folder)
{
    write_image(folder / "left.tif", pair.left);
    write_image(folder / "right.tif", pair.right);
}

FileMatch match_files(const std::string& left, const std::string& right,
                      tiling::DisparityRange asked, const matcher::Options& options,
                      int threads, int repeats, const std::filesystem::path& folder)
{
    pipeline::Job job;
    job.left.path = left;
    job.right.path = right;
    job.disparity = asked;
    job.matcher = options;
    job.run.threads = threads;
    job.outputs.disparity = folder / "disparity.tif";
    job.outputs.confidence = folder / "confidence.tif";
    job.outputs.reasons = folder / "reasons.tif";
    FileMatch match;
    match.threads = threads;
    const PeakMemoryWatch watch;
    for (int i = 0; i <= repeats; ++i) {
        const auto start = std::chrono::steady_clock::now();
        const pipeline::PlannedJob planned = pipeline::plan_job(job);
        pipeline::run_job(planned, [](int, int) {});
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
        match.tile_size_px = planned.budget.tile_size_px;
        if (i == 0) {
            match.memory = watch.peak();
        } else {
            match.seconds.push_back(time.count());
        }
    }
    return match;
}

} // namespace hsgm::bench
