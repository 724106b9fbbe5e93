#pragma once

#include "pipeline/geometry/lattice.h"
#include "pipeline/geometry/resampler.h"
#include "pipeline/stages/pixel_source.h"

namespace hsgm::pipeline {

/// A file drawn into an epipolar frame on the way. Whole numbers stay whole numbers of the
/// file's type; what the frame shows from outside the file has no value.
class ResampledSource final : public PixelSource {
public:
    /// `sensor_from_frame` (x and y in the file) must outlive this.
    ResampledSource(io::RasterSource raster, const geometry::Lattice& sensor_from_frame,
                    tiling::Size frame, geometry::Kernel kernel = geometry::Kernel::lanczos);

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
