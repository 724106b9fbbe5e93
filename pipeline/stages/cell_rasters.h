#pragma once

#include "pipeline/stages/pair_cells.h"
#include "pipeline/stages/raster_group.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// What the rasters of heights are made of and say of themselves.
struct DsmOptions {
    CellManner cells;
    std::string map_wkt; ///< of the ground points, with its vertical datum if any
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
    std::filesystem::path reasons; ///< why cells have no value (`dsm::Missing`)
    std::filesystem::path pairs;   ///< of several pairs: how many agree on a cell
};

struct DsmSummary {
    dsm::DsmGrid grid;
    std::int64_t cells_with_value = 0;
    std::array<std::int64_t, dsm::kMissingNames.size()> with_reason{}; ///< by `dsm::Missing`
};

/// What a raster of heights, or of anything else, says of itself.
io::RasterOptions height_raster(const DsmOptions& options, const char* description,
                                const char* unit);
io::RasterOptions plain_raster(const DsmOptions& options, const char* description,
                               const char* unit);

/// The rasters of a DSM, written block by block in one order.
class CellRasters {
public:
    CellRasters(const dsm::DsmGrid& grid, const DsmOptions& options, const DsmPaths& paths);

    /// The blocks of a grid, in the order in which they are written.
    static std::vector<tiling::Rect> blocks_of(const dsm::DsmGrid& grid);
    static constexpr tiling::Size kBlock{256, 1024};

    void write(const tiling::Rect& block, const ReasonedCells& cells);
    /// How many pairs agree, where `paths.pairs` was asked for.
    void write_pairs(const tiling::Rect& block, const tiling::Image<std::uint8_t>& pairs);
    /// Gives all of them their names; the DSM and its reasons become cloud-optimized.
    DsmSummary finish();

private:
    DsmPaths paths_;
    std::vector<std::string> creation_options_;
    RasterGroup rasters_;
    DsmSummary summary_;
};

} // namespace hsgm::pipeline
