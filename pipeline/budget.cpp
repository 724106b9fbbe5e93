#include "pipeline/budget.h"

#include "io/hillshade.h"
#include "matcher/memory.h"
#include "pipeline/error.h"
#include "pipeline/stages/first_pass.h"
#include "pipeline/stages/prepare_stage.h"
#include "pipeline/stages/refine_stage.h"
#include "pipeline/stages/satellite_memory.h"
#include "pipeline/stages/satellite_stage.h"

#include <fmt/format.h>
#include <tbb/info.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>

namespace hsgm::pipeline {

namespace {

constexpr std::int64_t kMiB = std::int64_t{1} << 20;
/// The program and its libraries (50 MiB at the start, 72 once all are at work, measured),
/// stacks, ledgers, and what the allocator holds back.
constexpr std::int64_t kBaseBytes = 80 * kMiB;
/// Two sources: a strip of doubles and of pixels each, and GDAL's decoded blocks.
constexpr std::int64_t kStripBytes = 2 * (16 * kMiB + 4 * kMiB + 8 * kMiB);
/// Larger tiles repeat less work at their borders, but gain little beyond this.
constexpr std::array<int, 8> kTileSizes{1024, 768, 512, 384, 256, 192, 128, 64};

std::optional<std::uint64_t> read_number(const char* path)
{
    std::ifstream file(path);
    std::uint64_t value = 0;
    if (file >> value) {
        return value;
    }
    return std::nullopt;
}

// Fills in what a tile size takes.
void set_tiles(Budget& budget, const matcher::Matcher& matcher, int tile)
{
    budget.tile_size_px = tile;
    budget.tiles = tiling::TilePlan(matcher.pair().shape.left, tile).count();
    budget.workers = std::min(budget.tiles, std::min(budget.threads, 2));
    budget.tiles_in_flight = std::min(budget.tiles, budget.workers + 1);
    // Every worker has a tile and they share the threads; the other tiles in flight wait for
    // a worker, or for the writer.
    const std::int64_t tile_bytes = matcher.tile_bytes(tile, 0);
    const std::int64_t thread_bytes = matcher.tile_bytes(tile, 1) - tile_bytes;
    budget.tiles_bytes =
        kBaseBytes + matcher::coarse_kept_bytes(matcher) + budget.workers * tile_bytes +
        (budget.tiles_in_flight - budget.workers) * matcher::waiting_tile_bytes(matcher, tile) +
        budget.threads * thread_bytes;
    budget.estimate_bytes =
        budget.held_bytes + std::max({budget.prepare_bytes, budget.coarse_bytes,
                                      budget.tiles_bytes, budget.refine_bytes});
}

std::string mebibytes(std::int64_t bytes)
{
    return fmt::format("{} MiB", (bytes + kMiB - 1) / kMiB);
}

// What would make it fit: only what the stages over the limit depend on.
std::string advice(const Budget& budget, matcher::Mode mode, bool tile_size_given)
{
    std::string text = "allow more with --memory";
    if (std::max(budget.prepare_bytes, budget.refine_bytes) > budget.memory_bytes) {
        return text; // every run takes that
    }
    if (mode == matcher::Mode::sgm) {
        return text + ", or use mode hsgm, which is not solved in one piece";
    }
    if (budget.tiles_bytes > budget.memory_bytes) {
        text += tile_size_given ? ", choose smaller tiles" : ", use fewer threads";
    }
    return text;
}

// What comes after the second pass: the DSM of a raw pair, and shading.
std::int64_t heights_bytes(const Job& job, const matcher::PairShape& shape, int threads)
{
    if (job.satellite) {
        return satellite_bytes(job, threads);
    }
    return job.outputs.hillshade.empty() ? 0 : io::hillshade_bytes(shape.left);
}

// What comes before the tiles: finding the geometry of a raw pair, streaming both images, and
// learning the table of cost hmi.
std::int64_t preparing_bytes(const matcher::Matcher& matcher, const Job& job)
{
    std::int64_t bytes = kStripBytes + static_cast<std::int64_t>(gdal_cache_bytes());
    if (job.satellite && job.satellite->stored.empty()) {
        bytes = std::max(bytes, search_bytes(*job.satellite->pair));
    }
    if (job.matcher.cost == matcher::Cost::hmi) {
        bytes = std::max(bytes, matcher::hmi_table_bytes(matcher));
    }
    return bytes;
}

std::int64_t output_bytes(const Job& job, const matcher::PairShape& shape)
{
    const int floats =
        1 + job.geometry.height_per_px_m.has_value() + !job.outputs.depth.empty();
    return shape.left.area() * (4 * floats + 1 + 2 + !job.outputs.hillshade.empty()) +
           (job.satellite ? satellite_output_bytes(job) : 0);
}

} // namespace

std::uint64_t available_memory_bytes()
{
    std::uint64_t bytes = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                          static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
    for (const char* limit :
         {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
        if (const auto value = read_number(limit)) {
            bytes = std::min(bytes, *value);
        }
    }
    return bytes;
}

std::size_t gdal_cache_bytes()
{
    return 16 << 20;
}

Budget make_budget(const matcher::Matcher& matcher, const Job& job, int pyramid_levels)
{
    const auto& shape = matcher.pair().shape;
    Budget budget;
    budget.threads = job.run.threads > 0 ? job.run.threads : tbb::info::default_concurrency();
    budget.memory_bytes = static_cast<std::int64_t>(
        job.run.memory_bytes.value_or(available_memory_bytes() / 5 * 4));
    budget.prepare_bytes = kBaseBytes + preparing_bytes(matcher, job);
    budget.coarse_bytes = kBaseBytes + matcher.coarse_bytes();
    budget.refine_bytes =
        kBaseBytes + std::max(refine_bytes(shape, job.matcher, budget.threads),
                              heights_bytes(job, shape, budget.threads));
    budget.held_bytes = job.satellite ? held_bytes(job) : 0;
    budget.pyramid_disk_bytes = PreparedPair::disk_bytes(shape, pyramid_levels);
    budget.scratch_disk_bytes =
        budget.pyramid_disk_bytes + FirstPass::disk_bytes(shape, shape.left.rows);
    budget.output_disk_bytes = output_bytes(job, shape);
    if (job.run.tile_size_px) {
        set_tiles(budget, matcher, *job.run.tile_size_px);
        if (budget.estimate_bytes <= budget.memory_bytes) {
            return budget;
        }
    } else {
        for (const int tile : kTileSizes) {
            set_tiles(budget, matcher, tile);
            if (budget.estimate_bytes <= budget.memory_bytes) {
                return budget;
            }
        }
    }
    const auto mode = matcher.options().mode;
    throw BudgetError(
        fmt::format("mode {} with tiles of {} px and {} threads needs {} of memory, but may "
                    "take {}: {}",
                    name(mode), budget.tile_size_px, budget.threads,
                    mebibytes(budget.estimate_bytes), mebibytes(budget.memory_bytes),
                    advice(budget, mode, job.run.tile_size_px.has_value())));
}

} // namespace hsgm::pipeline
