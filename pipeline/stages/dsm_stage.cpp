#include "pipeline/stages/dsm_stage.h"

#include "io/error.h"
#include "matcher/refine.h"
#include "pipeline/stages/ordered_pieces.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace hsgm::pipeline {

namespace {

using tiling::Image;
using tiling::Rect;

struct FramePiece {
    Image<float> height;
    Image<float> residual;
    PieceSurvey survey;
};

FramePiece frame_piece(const PointPiece& points)
{
    FramePiece piece{Image<float>(points.rect.size(), matcher::kNodataDisparity),
                     Image<float>(points.rect.size(), matcher::kNodataDisparity),
                     survey_of(points)};
    for (std::size_t i = 0; i < points.x.size(); ++i) {
        if (!std::isnan(points.height_m[i])) {
            piece.height.data()[i] = static_cast<float>(points.height_m[i]);
            piece.residual.data()[i] = points.residual_px[i];
        }
    }
    return piece;
}

/// Reads every piece of the frame and hands over what `look` makes of it, in order.
template <typename Look, typename Take>
void walk(const MatchedPair& pair, const std::vector<Rect>& pieces, const Look& look,
          const Take& take)
{
    tbb::enumerable_thread_specific<std::unique_ptr<PointReader>> readers;
    in_order(
        pieces.size(),
        [&](std::size_t i) {
            auto& reader = readers.local();
            if (!reader) {
                reader = std::make_unique<PointReader>(*pair.ground, pair.disparity,
                                                       pair.confidence);
            }
            return look(reader->read(pieces[i]));
        },
        take);
}

/// Writes the heights of the frame; what each piece of it holds.
std::vector<PieceSurvey> write_heights(const MatchedPair& pair, const DsmOptions& options,
                                       const DsmPaths& paths)
{
    const auto pieces = PairCells::pieces_of_frame(pair.images.frame->size);
    RasterGroup rasters(pair.images.frame->size);
    rasters.add(paths.height, io::PixelType::float32,
                height_raster(options, "height", "metre"));
    rasters.add(paths.residual, io::PixelType::float32,
                height_raster(options, "distance of the rays", "pixel"));
    std::vector<PieceSurvey> surveys(pieces.size());
    walk(pair, pieces, frame_piece, [&](std::size_t i, const FramePiece& piece) {
        rasters.write(0, pieces[i], piece.height);
        rasters.write(1, pieces[i], piece.residual);
        surveys[i] = piece.survey;
    });
    rasters.finish();
    return surveys;
}

} // namespace

std::vector<PieceSurvey> survey_pair(const MatchedPair& pair)
{
    const auto pieces = PairCells::pieces_of_frame(pair.images.frame->size);
    std::vector<PieceSurvey> surveys(pieces.size());
    walk(pair, pieces, survey_of,
         [&](std::size_t i, const PieceSurvey& survey) { surveys[i] = survey; });
    return surveys;
}

dsm::DsmGrid grid_over(dsm::Bounds points, const CellManner& manner, const std::string& where)
{
    if (points.empty()) {
        throw io::InputError(fmt::format("not a single pixel of {} has a disparity: the images "
                                         "show nothing alike within the range of heights",
                                         where));
    }
    if (manner.region) {
        const dsm::Bounds& region = manner.region->bounds();
        points = {std::max(points.west, region.west), std::max(points.south, region.south),
                  std::min(points.east, region.east), std::min(points.north, region.north)};
        if (points.empty()) {
            throw io::InputError(fmt::format("not a single pixel of {} that has a height lies "
                                             "in the region of interest",
                                             where));
        }
    }
    return dsm::make_grid(points, manner.cell_m * manner.map_units_per_m);
}

DsmSummary write_dsm(const MatchedPair& pair, const DsmOptions& options, const DsmPaths& paths)
{
    const PairCells pair_cells(pair, options.cells, write_heights(pair, options, paths));
    const dsm::DsmGrid grid =
        grid_over(pair_cells.bounds(), options.cells, pair.disparity.string());
    CellRasters rasters(grid, options, paths);
    const auto blocks = CellRasters::blocks_of(grid);
    in_order(
        blocks.size(),
        [&](std::size_t i) {
            ReasonedCells cells = pair_cells.block(grid, blocks[i]);
            remove_uncertain(cells, options.cells.min_confidence);
            return cells;
        },
        [&](std::size_t i, const ReasonedCells& cells) { rasters.write(blocks[i], cells); });
    return rasters.finish();
}

std::int64_t dsm_bytes(double gsd_m, double cell_m, int threads)
{
    return pieces_in_flight(threads) * PairCells::bytes(CellRasters::kBlock, gsd_m, cell_m);
}

} // namespace hsgm::pipeline
