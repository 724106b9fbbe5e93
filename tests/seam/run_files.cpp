#include "tests/seam/run_files.h"

#include "io/geotiff_writer.h"
#include "io/raster_source.h"
#include "matcher/pixel.h"
#include "pipeline/stages/match_stage.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace hsgm::seam {

namespace {

using tiling::Image;

template <typename T, typename Convert>
void write_image(const Image<std::uint16_t>& image, const std::filesystem::path& path,
                 std::optional<double> nodata, Convert convert)
{
    Image<T> stored(image.size());
    const auto from = image.pixels();
    std::transform(from.begin(), from.end(), stored.data(), convert);
    io::RasterOptions options;
    options.nodata = nodata;
    io::GeoTiffWriter writer(path, image.size(), io::pixel_type_of<T>(), options);
    writer.write(rect_of(image.size()), stored);
    writer.finish();
}

void write_stored(const Image<std::uint16_t>& image, const std::filesystem::path& path,
                  Storage storage)
{
    using matcher::is_valid;
    if (storage == Storage::uint8) {
        write_image<std::uint8_t>(image, path, 0, [](std::uint16_t v) {
            return is_valid(v) ? static_cast<std::uint8_t>(v) : std::uint8_t{0};
        });
    } else if (storage == Storage::uint16) {
        write_image<std::uint16_t>(image, path, 7, [](std::uint16_t v) {
            return is_valid(v) ? static_cast<std::uint16_t>(8 * v) : std::uint16_t{7};
        });
    } else {
        int missing = 0;
        write_image<float>(image, path, -1, [&missing](std::uint16_t v) {
            if (is_valid(v)) {
                return 0.37F * static_cast<float>(v) - 0.5F;
            }
            return ++missing % 2 == 0 ? -1.0F : std::numeric_limits<float>::quiet_NaN();
        });
    }
}

std::string bytes_of(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw std::runtime_error("no file " + path.string());
    }
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<double> pixels_of(const std::filesystem::path& path)
{
    constexpr double kMissing = -1e30;
    io::RasterSource source({path.string()});
    Image<double> values(source.size());
    source.read(rect_of(source.size()), values.view());
    std::vector<double> pixels(values.pixels().begin(), values.pixels().end());
    std::replace_if(
        pixels.begin(), pixels.end(), [](double v) { return std::isnan(v); }, kMissing);
    return pixels;
}

} // namespace

TemporaryFolder::TemporaryFolder(const std::filesystem::path& parent)
{
    std::string name = (parent / "hsgm-seam-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
        throw std::runtime_error("no temporary folder " + name);
    }
    path_ = name;
}

TemporaryFolder::~TemporaryFolder()
{
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

void set_outputs(pipeline::Job& job, const std::filesystem::path& folder)
{
    job.geometry.height_per_px_m = 0.35;
    job.geometry.reference_height_m = 12.5;
    job.outputs.disparity = folder / "disparity.tif";
    job.outputs.confidence = folder / "confidence.tif";
    job.outputs.reasons = folder / "reasons.tif";
    job.outputs.height = folder / "height.tif";
    job.outputs.hillshade = folder / "hillshade.png";
}

pipeline::Job write_pair(const StereoPair& pair, Storage storage,
                         const std::filesystem::path& folder)
{
    pipeline::Job job;
    job.left.path = (folder / "left.tif").string();
    job.right.path = (folder / "right.tif").string();
    job.disparity = pair.asked;
    write_stored(pair.left, job.left.path, storage);
    write_stored(pair.right, job.right.path, storage);
    set_outputs(job, folder);
    return job;
}

std::vector<StoredRaster> stored_rasters(const std::vector<std::filesystem::path>& paths)
{
    std::vector<StoredRaster> rasters;
    for (const auto& path : paths) {
        rasters.push_back({path.filename().string(), bytes_of(path), pixels_of(path)});
    }
    return rasters;
}

std::vector<StoredRaster> run(const pipeline::Job& job)
{
    pipeline::run_job(pipeline::plan_job(job), [](int, int) {});
    return stored_rasters({job.outputs.disparity, job.outputs.confidence, job.outputs.reasons,
                           job.outputs.height, job.outputs.hillshade});
}

std::string difference(const std::vector<StoredRaster>& a, const std::vector<StoredRaster>& b)
{
    std::string found;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i].pixels != b[i].pixels) {
            found += a[i].name + ": pixels differ; ";
        }
        if (a[i].bytes != b[i].bytes) {
            found += a[i].name + ": bytes differ; ";
        }
    }
    return found;
}

std::string text(const Manner& manner)
{
    constexpr const char* kOrders[] = {"rows", "columns", "reversed", "shuffled"};
    return "tile size " +
           (manner.tile_size_px ? std::to_string(*manner.tile_size_px) : "by budget") +
           ", threads " + std::to_string(manner.threads) + ", order " +
           kOrders[static_cast<int>(manner.order)] +
           (manner.memory_bytes ? ", " + std::to_string(*manner.memory_bytes >> 20) + " MiB"
                                : "");
}

std::string differences_between(pipeline::Job job, const std::vector<Manner>& manners)
{
    const bool talk = std::getenv("HSGM_SEAM_VERBOSE") != nullptr;
    std::string found;
    std::vector<StoredRaster> first;
    for (const Manner& manner : manners) {
        job.run.tile_size_px = manner.tile_size_px;
        job.run.threads = manner.threads;
        job.run.order = manner.order;
        job.run.memory_bytes = manner.memory_bytes;
        const auto start = std::chrono::steady_clock::now();
        auto rasters = run(job);
        if (talk) {
            const std::chrono::duration<double> taken =
                std::chrono::steady_clock::now() - start;
            std::printf("%s: %.1f s\n", text(manner).c_str(), taken.count());
            std::fflush(stdout);
        }
        if (first.empty()) {
            first = std::move(rasters);
            continue;
        }
        const std::string differs = difference(first, rasters);
        if (!differs.empty()) {
            found += text(manner) + ": " + differs + "\n";
        }
    }
    return found;
}

} // namespace hsgm::seam
