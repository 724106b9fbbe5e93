#pragma once

#include "pipeline/geometry/lattice.h"
#include "pipeline/geometry/relief_warp.h"
#include "pipeline/geometry/resampler.h"
#include "pipeline/stages/pixel_source.h"

#include <memory>

namespace hsgm::pipeline {

/// A file drawn into an epipolar frame on the way. Whole numbers stay whole numbers of the
/// file's type; what the frame shows from outside the file has no value.
class ResampledSource final : public PixelSource {
public:
    /// `sensor_from_frame` must outlive this: x and y in the file or, with a warp, in the
    /// levelled image that belongs to it.
    ResampledSource(io::RasterSource raster, const geometry::Lattice& sensor_from_frame,
                    tiling::Size frame,
                    std::shared_ptr<const geometry::ReliefWarp> warp = nullptr);

    tiling::Size size() const override { return frame_; }
    io::PixelType pixel_type() const override { return raster_.pixel_type(); }
    std::string description() const override;
    std::vector<tiling::Rect> reading_windows() const override;
    void read(const tiling::Rect& window, tiling::ImageView<double> values) override;

private:
    io::RasterSource raster_;
    tiling::Size frame_;
    geometry::Resampler resampler_;
};

} // namespace hsgm::pipeline
