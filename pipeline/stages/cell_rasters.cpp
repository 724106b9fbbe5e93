#include "pipeline/stages/cell_rasters.h"

#include "io/cog.h"
#include "pipeline/stages/ordered_pieces.h"

#include <fmt/format.h>

namespace hsgm::pipeline {

namespace {

enum Raster : std::size_t { kHeight, kConfidence, kPoints, kSpread, kReasons, kPairs };

} // namespace

io::RasterOptions plain_raster(const DsmOptions& options, const char* description,
                               const char* unit)
{
    io::RasterOptions result;
    result.metadata = options.metadata;
    result.band_descriptions = {description};
    result.unit = unit;
    result.creation_options = options.creation_options;
    return result;
}

io::RasterOptions height_raster(const DsmOptions& options, const char* description,
                                const char* unit)
{
    io::RasterOptions result = plain_raster(options, description, unit);
    result.nodata = double{dsm::kNoHeight};
    return result;
}

CellRasters::CellRasters(const dsm::DsmGrid& grid, const DsmOptions& options,
                         const DsmPaths& paths)
    : paths_(paths), creation_options_(options.creation_options), rasters_(grid.size)
{
    summary_.grid = grid;
    const auto add = [&](const std::filesystem::path& path, io::PixelType type,
                         io::RasterOptions raster) {
        raster.geo = {grid.transform(), options.map_wkt};
        rasters_.add(path, type, std::move(raster));
    };
    using io::PixelType;
    add(paths.dsm, PixelType::float32,
        height_raster(options, "height of the surface", "metre"));
    add(paths.confidence, PixelType::uint8,
        plain_raster(options, "confidence (0 = no value)", ""));
    add(paths.points, PixelType::uint8,
        plain_raster(options, "points of a cell, at most 255", ""));
    add(paths.spread, PixelType::float32,
        height_raster(options, "spread of a cell's points", "metre"));
    io::RasterOptions reasons = plain_raster(options, "why a cell has no height", "");
    for (const auto& [reason, name] : dsm::kMissingNames) {
        reasons.metadata[fmt::format("REASON_{}", static_cast<int>(reason))] = name;
    }
    add(paths.reasons, PixelType::uint8, std::move(reasons));
    add(paths.pairs, PixelType::uint8, plain_raster(options, "pairs that agree on a cell", ""));
}

std::vector<tiling::Rect> CellRasters::blocks_of(const dsm::DsmGrid& grid)
{
    return pieces_of(grid.size, kBlock);
}

void CellRasters::write(const tiling::Rect& block, const ReasonedCells& cells)
{
    rasters_.write(kHeight, block, cells.cells.height);
    rasters_.write(kConfidence, block, cells.cells.confidence);
    rasters_.write(kPoints, block, cells.cells.points);
    rasters_.write(kSpread, block, cells.cells.spread);
    rasters_.write(kReasons, block, cells.reasons);
    for (const std::uint8_t reason : cells.reasons.pixels()) {
        ++summary_.with_reason[reason];
    }
}

void CellRasters::write_pairs(const tiling::Rect& block,
                              const tiling::Image<std::uint8_t>& pairs)
{
    rasters_.write(kPairs, block, pairs);
}

DsmSummary CellRasters::finish()
{
    rasters_.finish();
    summary_.cells_with_value = summary_.with_reason[0];
    io::make_cloud_optimized(paths_.dsm.string(), creation_options_);
    if (!paths_.reasons.empty()) {
        io::make_cloud_optimized(paths_.reasons.string(), creation_options_,
                                 io::Overviews::nearest);
    }
    return summary_;
}

} // namespace hsgm::pipeline
