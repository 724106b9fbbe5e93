#include "pipeline/stages/dsm_stage.h"

#include "io/cog.h"
#include "io/error.h"
#include "io/geotiff_writer.h"
#include "matcher/refine.h"
#include "pipeline/dsm/cell_block.h"
#include "pipeline/stages/ground_points.h"
#include "pipeline/stages/ordered_pieces.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace hsgm::pipeline {

namespace {

using tiling::Image;
using tiling::Rect;
using tiling::Size;

constexpr Size kFramePiece{256, 256};
constexpr Size kGroundPiece{256, 1024};
/// Of the larger of cell and ground sampling distance: every cell of a closed surface finds
/// about four points.
constexpr double kRadius = 1.2;
/// Of a cell: neighbouring points of one surface rarely differ by more.
constexpr double kLayerGap = 2.0;

using Readers = tbb::enumerable_thread_specific<std::unique_ptr<PointReader>>;

PointReader& reader_of(Readers& readers, const MatchedPair& pair)
{
    auto& reader = readers.local();
    if (!reader) {
        reader = std::make_unique<PointReader>(*pair.ground, pair.disparity, pair.confidence);
    }
    return *reader;
}

io::RasterOptions raster_options(const DsmOptions& options, const char* description,
                                 const char* unit)
{
    io::RasterOptions result;
    result.metadata = options.metadata;
    result.band_descriptions = {description};
    result.unit = unit;
    result.creation_options = options.creation_options;
    return result;
}

io::RasterOptions float_options(const DsmOptions& options, const char* description,
                                const char* unit)
{
    io::RasterOptions result = raster_options(options, description, unit);
    result.nodata = double{dsm::kNoHeight};
    return result;
}

/// Several rasters of one size that get their names together.
class Rasters {
public:
    explicit Rasters(Size size) : size_(size) {}

    void add(const std::filesystem::path& path, io::PixelType type, io::RasterOptions options)
    {
        writers_.push_back(path.empty() ? nullptr
                                        : std::make_unique<io::GeoTiffWriter>(
                                              path.string(), size_, type, std::move(options)));
    }
    template <typename T>
    void write(std::size_t raster, const Rect& rect, const Image<T>& pixels)
    {
        if (writers_[raster]) {
            writers_[raster]->write(rect, pixels);
        }
    }
    void finish()
    {
        for (const auto& writer : writers_) {
            if (writer) {
                writer->complete();
            }
        }
        for (const auto& writer : writers_) {
            if (writer) {
                writer->publish();
            }
        }
    }

private:
    Size size_;
    std::vector<std::unique_ptr<io::GeoTiffWriter>> writers_;
};

struct FramePiece {
    Image<float> height;
    Image<float> residual;
    dsm::Bounds bounds;
};

FramePiece frame_piece(const PointPiece& points)
{
    FramePiece piece{Image<float>(points.rect.size(), matcher::kNodataDisparity),
                     Image<float>(points.rect.size(), matcher::kNodataDisparity),
                     {}};
    for (std::size_t i = 0; i < points.x.size(); ++i) {
        if (!std::isnan(points.height_m[i])) {
            piece.height.data()[i] = static_cast<float>(points.height_m[i]);
            piece.residual.data()[i] = points.residual_px[i];
            piece.bounds.include(points.x[i], points.y[i]);
        }
    }
    return piece;
}

/// Writes the heights of the frame; what each piece of it covers on the map.
std::vector<dsm::Bounds> write_heights(const MatchedPair& pair, const DsmOptions& options,
                                       const DsmPaths& paths, Readers& readers,
                                       const std::vector<Rect>& pieces, Size frame)
{
    Rasters rasters(frame);
    rasters.add(paths.height, io::PixelType::float32,
                float_options(options, "height", "metre"));
    rasters.add(paths.residual, io::PixelType::float32,
                float_options(options, "distance of the rays", "pixel"));
    std::vector<dsm::Bounds> bounds(pieces.size());
    in_order(
        pieces.size(),
        [&](std::size_t i) { return frame_piece(reader_of(readers, pair).read(pieces[i])); },
        [&](std::size_t i, const FramePiece& piece) {
            rasters.write(0, pieces[i], piece.height);
            rasters.write(1, pieces[i], piece.residual);
            bounds[i] = piece.bounds;
        });
    rasters.finish();
    return bounds;
}

void add_points(const PointPiece& points, dsm::CellBlock& block)
{
    for (std::size_t i = 0; i < points.x.size(); ++i) {
        const double confidence = points.confidence.data()[i];
        if (!std::isnan(points.height_m[i])) {
            // A pixel with a value has a confidence; should a foreign file not have it, the
            // point counts for little.
            block.add(points.x[i], points.y[i], points.height_m[i],
                      std::isnan(confidence) ? std::uint8_t{1}
                                             : static_cast<std::uint8_t>(confidence));
        }
    }
}

dsm::CellOptions cell_options(double gsd_m, double cell_m, double units_per_m)
{
    dsm::CellOptions options;
    options.radius = kRadius * std::max(gsd_m, cell_m) * units_per_m;
    options.layer_gap = kLayerGap * std::max(gsd_m, cell_m);
    return options;
}

DsmSummary write_cells(const MatchedPair& pair, const DsmOptions& options,
                       const DsmPaths& paths, Readers& readers, const std::vector<Rect>& pieces,
                       const std::vector<dsm::Bounds>& bounds, const dsm::DsmGrid& grid)
{
    const auto with_place = [&](io::RasterOptions raster) {
        raster.geo = {grid.transform(), options.map_wkt};
        return raster;
    };
    Rasters rasters(grid.size);
    rasters.add(paths.dsm, io::PixelType::float32,
                with_place(float_options(options, "height of the surface", "metre")));
    rasters.add(paths.confidence, io::PixelType::uint8,
                with_place(raster_options(options, "confidence (0 = no value)", "")));
    rasters.add(paths.points, io::PixelType::uint8,
                with_place(raster_options(options, "points of a cell, at most 255", "")));
    rasters.add(paths.spread, io::PixelType::float32,
                with_place(float_options(options, "spread of a cell's points", "metre")));
    const auto blocks = pieces_of(grid.size, kGroundPiece);
    const dsm::CellOptions how =
        cell_options(pair.gsd_m, options.cell_m, options.map_units_per_m);
    DsmSummary summary{grid, 0};
    in_order(
        blocks.size(),
        [&](std::size_t i) {
            dsm::CellBlock block(grid, blocks[i], how);
            for (std::size_t p = 0; p < pieces.size(); ++p) {
                if (!bounds[p].empty() && bounds[p].meets(block.reach(), 0)) {
                    add_points(reader_of(readers, pair).read(pieces[p]), block);
                }
            }
            return block.finish();
        },
        [&](std::size_t i, const dsm::Cells& cells) {
            rasters.write(0, blocks[i], cells.height);
            rasters.write(1, blocks[i], cells.confidence);
            rasters.write(2, blocks[i], cells.points);
            rasters.write(3, blocks[i], cells.spread);
            for (const std::uint8_t points : cells.points.pixels()) {
                summary.cells_with_value += points > 0;
            }
        });
    rasters.finish();
    return summary;
}

} // namespace

DsmSummary write_dsm(const MatchedPair& pair, const DsmOptions& options, const DsmPaths& paths)
{
    Readers readers;
    const Size frame = reader_of(readers, pair).size();
    const auto pieces = pieces_of(frame, kFramePiece);
    const auto bounds = write_heights(pair, options, paths, readers, pieces, frame);
    dsm::Bounds all;
    for (const dsm::Bounds& piece : bounds) {
        all.include(piece);
    }
    if (all.empty()) {
        throw io::InputError(fmt::format("not a single pixel of {} has a disparity: the images "
                                         "show nothing alike within the range of heights",
                                         pair.disparity.string()));
    }
    const dsm::DsmGrid grid = dsm::make_grid(all, options.cell_m * options.map_units_per_m);
    const DsmSummary summary = write_cells(pair, options, paths, readers, pieces, bounds, grid);
    readers.clear();
    io::make_cloud_optimized(paths.dsm.string(), options.creation_options);
    return summary;
}

std::int64_t dsm_bytes(double gsd_m, double cell_m, int threads)
{
    constexpr std::int64_t kPointBytes = 4 + 8 + 8 + 3 * 8 + 4;
    constexpr std::int64_t kStoredPoint = 40;
    constexpr std::int64_t kCellBytes = 4 + 4 + 1 + 1 + 8;
    const double per_cell = std::max(1.0, cell_m * cell_m / (gsd_m * gsd_m));
    // Surfaces that lie above each other, as facades do, bring more points to a cell.
    const auto points =
        static_cast<std::int64_t>(static_cast<double>(kGroundPiece.area()) * per_cell * 2.5);
    return pieces_in_flight(threads) *
           (kFramePiece.area() * kPointBytes + points * kStoredPoint +
            kGroundPiece.area() * kCellBytes);
}

} // namespace hsgm::pipeline
