#pragma once

#include "pipeline/dsm/dsm_grid.h"
#include "pipeline/geometry/ground_lattice.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// A finished match whose pixels become ground points.
struct MatchedPair {
    std::filesystem::path disparity;
    std::filesystem::path confidence;
    const geometry::GroundLattice* ground = nullptr;
    double gsd_m = 0; ///< of its frame, in metres
};

/// What the rasters of heights are made of and say of themselves.
struct DsmOptions {
    double cell_m = 1;          ///< side of a cell of the DSM
    std::string map_wkt;        ///< of the ground points, with its vertical datum if any
    double map_units_per_m = 1; ///< 1 in metric maps
    std::map<std::string, std::string> metadata;
    std::vector<std::string> creation_options;
};

/// Where they go; an empty path: not asked for.
struct DsmPaths {
    std::filesystem::path height;   ///< in the frame, beside the disparities
    std::filesystem::path residual; ///< likewise: how far the rays pass each other
    std::filesystem::path dsm;
    std::filesystem::path confidence;
    std::filesystem::path points;
    std::filesystem::path spread;
};

struct DsmSummary {
    dsm::DsmGrid grid;
    std::int64_t cells_with_value = 0;
};

/// Heights in the frame, then the DSM on the map. Both walk fixed pieces in a fixed order, on
/// the threads of the arena it is called in: the same bytes for whatever tiles the match had.
/// Rasters get their names when all of them are whole; the DSM is a cloud-optimized GeoTIFF.
/// Throws InputError where not a single pixel has a disparity.
DsmSummary write_dsm(const MatchedPair& pair, const DsmOptions& options, const DsmPaths& paths);

/// Upper bound of the memory that it takes with this many threads.
std::int64_t dsm_bytes(double gsd_m, double cell_m, int threads);

} // namespace hsgm::pipeline
