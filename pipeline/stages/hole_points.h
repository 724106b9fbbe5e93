#pragma once

#include "io/raster_source.h"
#include "pipeline/dsm/missing.h"
#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/geometry/ground_lattice.h"
#include "pipeline/stages/ground_points.h"

#include <filesystem>
#include <vector>

namespace hsgm::pipeline {

/// Where a pixel without a disparity would lie on the ground, and why it has none.
struct HolePoint {
    double x = 0;
    double y = 0;
    dsm::Missing reason = dsm::Missing::none;
};

/// What tells where a frame's pixels come from.
struct FrameImages {
    const geometry::EpipolarFrame* frame = nullptr;
    tiling::Size left; ///< of the source images
    tiling::Size right;
};

/// Lays the holes of a disparity map on the ground: each pixel once with the disparity of the
/// next pixel to the left that has one and once with that to the right, since either surface
/// may go on there. One for each thread.
class HoleReader {
public:
    /// What `ground` and `images` point to must outlive this.
    HoleReader(const geometry::GroundLattice& ground, const FrameImages& images,
               const std::filesystem::path& reasons);

    /// Disparities for pixels that have none beside them.
    struct Fallback {
        float piece_px = 0; ///< in rows without any
        float frame_px = 0; ///< beside the left image, one for the whole frame
    };
    /// The holes of a piece.
    std::vector<HolePoint> read(const PointPiece& piece, const Fallback& fallback);

private:
    struct Work;
    void add_points(const tiling::Rect& piece, int row, Work& work,
                    std::vector<HolePoint>& points) const;
    bool left_shows(int row, int col) const;
    dsm::Missing reason_of(int row, int col, unsigned bits, float disparity_px) const;

    const geometry::GroundLattice& ground_;
    FrameImages images_;
    io::RasterSource reasons_;
};

} // namespace hsgm::pipeline
