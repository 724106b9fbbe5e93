#include "pipeline/stages/ground_points.h"

#include <algorithm>
#include <limits>
#include <span>

namespace hsgm::pipeline {

PointPiece::PointPiece(const tiling::Rect& piece)
    : rect(piece), disparity_px(piece.size()), confidence(piece.size()),
      x(static_cast<std::size_t>(piece.area())), y(x.size()), height_m(x.size()),
      residual_px(x.size())
{
}

PointReader::PointReader(const geometry::GroundLattice& ground,
                         const std::filesystem::path& disparity,
                         const std::filesystem::path& confidence)
    : ground_(ground), disparity_(io::ImageSpec{disparity.string()}),
      // 0 means no value there, though the file declares none.
      confidence_(io::ImageSpec{confidence.string(), 1, 0.0})
{
}

PointPiece PointReader::read(const tiling::Rect& piece)
{
    PointPiece points(piece);
    tiling::Image<double> stored(piece.size());
    disparity_.read(piece, stored);
    confidence_.read(piece, points.confidence);
    std::transform(stored.pixels().begin(), stored.pixels().end(), points.disparity_px.data(),
                   [](double d) { return static_cast<float>(d); });
    const auto cols = static_cast<std::size_t>(piece.cols);
    for (int r = 0; r < piece.rows; ++r) {
        const std::size_t at = static_cast<std::size_t>(r) * cols;
        ground_.points(piece.row + r, piece.col, points.disparity_px.view().row_span(r),
                       {std::span(points.x).subspan(at, cols),
                        std::span(points.y).subspan(at, cols),
                        std::span(points.height_m).subspan(at, cols),
                        std::span(points.residual_px).subspan(at, cols)});
    }
    return points;
}

} // namespace hsgm::pipeline
