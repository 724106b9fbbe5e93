#pragma once

#include "io/raster_source.h"
#include "pipeline/geometry/ground_lattice.h"
#include "tiling/image.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace hsgm::pipeline {

/// The ground points of a piece of a disparity map, row by row; NaN where there is none.
struct PointPiece {
    explicit PointPiece(const tiling::Rect& piece);

    tiling::Rect rect;
    tiling::Image<float> disparity_px; ///< NaN: no value
    tiling::Image<double> confidence;  ///< 1 to 255; NaN: no value
    std::vector<double> x;
    std::vector<double> y;
    std::vector<double> height_m;
    std::vector<float> residual_px;
};

/// Reads finished disparities and turns them into ground points. One for each thread.
class PointReader {
public:
    /// `ground` must outlive this. The rasters are those of a match in the lattice's frame.
    PointReader(const geometry::GroundLattice& ground, const std::filesystem::path& disparity,
                const std::filesystem::path& confidence);

    tiling::Size size() const { return disparity_.size(); }
    PointPiece read(const tiling::Rect& piece);

private:
    const geometry::GroundLattice& ground_;
    io::RasterSource disparity_;
    io::RasterSource confidence_;
};

} // namespace hsgm::pipeline
