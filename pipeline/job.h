#pragma once

#include "io/image_spec.h"
#include "matcher/options.h"
#include "pipeline/satellite_options.h"
#include "tiling/disparity_range.h"
#include "tiling/tile_plan.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// How a run is carried out. Nothing here may change a pixel of a result.
struct RunOptions {
    std::optional<int> tile_size_px; ///< 0: untiled; absent: chosen to fit the memory
    tiling::TileOrder order = tiling::TileOrder::rows;
    int threads = 0;                           ///< 0: one for each processor
    std::optional<std::uint64_t> memory_bytes; ///< absent: 80 % of what the machine offers
    std::string device = "auto";               ///< auto, cpu, cuda or cuda:N
    /// A tile that takes longer counts as failed; 0: no limit.
    double tile_limit_s = 0;
    /// So long after that a worker that does not come back is left behind.
    double tile_grace_s = 10;
};

/// How a disparity of a rectified pair becomes a height or a depth; all absent: it does not.
struct RectifiedGeometry {
    /// height = reference_height_m + disparity * height_per_px_m
    std::optional<double> height_per_px_m;
    double reference_height_m = 0;
    /// depth = focal_px * baseline_m / disparity
    std::optional<double> focal_px;
    std::optional<double> baseline_m;
};

/// Where results go. The parents of all paths must exist.
struct OutputPaths {
    std::filesystem::path disparity;
    std::filesystem::path confidence;
    std::filesystem::path reasons;
    std::filesystem::path height; ///< empty: not asked for; likewise below
    std::filesystem::path depth;
    std::filesystem::path residual; ///< of raw pairs, as are those of the DSM
    std::filesystem::path dsm;
    std::filesystem::path dsm_confidence;
    std::filesystem::path dsm_points;
    std::filesystem::path dsm_spread;
    std::filesystem::path dsm_reasons;
    std::filesystem::path dsm_pairs; ///< of several pairs
    std::filesystem::path hillshade;
    std::filesystem::path disparity_picture; ///< PNG, as is hillshade_picture
    std::filesystem::path hillshade_picture;
    std::vector<std::string> creation_options; ///< GDAL's KEY=VALUE, for every raster

    /// All files that are asked for.
    std::vector<std::filesystem::path> files() const;
};

/// One pair to be matched: all that is known before a pixel is read.
struct Job {
    io::ImageSpec left;
    io::ImageSpec right;
    tiling::DisparityRange disparity;
    matcher::Options matcher;
    RectifiedGeometry geometry;
    std::optional<SatelliteOptions> satellite; ///< given: the pair is raw, with RPCs
    RunOptions run;
    OutputPaths outputs;
};

/// What defines a job's result, for the metadata of its rasters: the same for every tile
/// size, thread count and memory, and without paths or times.
std::map<std::string, std::string> provenance(const Job& job);

} // namespace hsgm::pipeline
