#pragma once

#include "matcher/matcher.h"
#include "pipeline/job.h"

#include <cstdint>

namespace hsgm::pipeline {

/// How a job will be carried out, and what it takes: computed before the first pixel.
struct Budget {
    int threads = 1;
    int tile_size_px = 0; ///< 0: untiled
    int tiles = 1;
    int workers = 1;                 ///< tiles that are matched side by side
    int tiles_in_flight = 1;         ///< tiles read, matched or waiting to be written
    std::int64_t memory_bytes = 0;   ///< what the run may take
    std::int64_t estimate_bytes = 0; ///< the highest of the stages below, and what is held
    std::int64_t prepare_bytes = 0;  ///< geometry of a raw pair, pyramids, table of cost hmi
    std::int64_t coarse_bytes = 0;   ///< solving the coarsest level whole
    std::int64_t tiles_bytes = 0;    ///< all tiles in flight
    std::int64_t refine_bytes = 0;   ///< second pass and writing
    std::int64_t held_bytes = 0;     ///< beside each of them: a pair's geometry, its DEM
    std::int64_t pyramid_disk_bytes = 0;
    std::int64_t scratch_disk_bytes = 0; ///< pyramids and first-pass results
    std::int64_t output_disk_bytes = 0;  ///< uncompressed: an upper bound
};

/// Memory of this machine, or of the cgroup that limits it, in bytes.
std::uint64_t available_memory_bytes();

/// GDAL's block cache, as this program sets it.
std::size_t gdal_cache_bytes();

/// Chooses tile size and tiles in flight for the memory allowed; neither changes a result.
/// Throws BudgetError, naming the least memory that would do, where nothing fits.
/// `pyramid_levels` counts the levels kept on scratch disk.
Budget make_budget(const matcher::Matcher& matcher, const Job& job, int pyramid_levels);

} // namespace hsgm::pipeline
