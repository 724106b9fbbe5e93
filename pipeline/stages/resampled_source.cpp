#include "pipeline/stages/resampled_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hsgm::pipeline {

namespace {

constexpr int kWindowPx = 1024;

struct Limits {
    double least = 0;
    double most = 0;
};

template <typename T>
Limits limits_of()
{
    return {static_cast<double>(std::numeric_limits<T>::lowest()),
            static_cast<double>(std::numeric_limits<T>::max())};
}

Limits limits_of(io::PixelType type)
{
    switch (type) {
    case io::PixelType::uint8:
        return limits_of<std::uint8_t>();
    case io::PixelType::uint16:
        return limits_of<std::uint16_t>();
    case io::PixelType::int16:
        return limits_of<std::int16_t>();
    case io::PixelType::uint32:
        return limits_of<std::uint32_t>();
    case io::PixelType::int32:
        return limits_of<std::int32_t>();
    default:
        return limits_of<double>();
    }
}

geometry::PlaceInSource through(std::shared_ptr<const geometry::ReliefWarp> warp)
{
    if (!warp) {
        return nullptr;
    }
    return
        [warp = std::move(warp)](geometry::ImagePoint place) { return warp->source_of(place); };
}

} // namespace

ResampledSource::ResampledSource(io::RasterSource raster,
                                 const geometry::Lattice& sensor_from_frame, tiling::Size frame,
                                 std::shared_ptr<const geometry::ReliefWarp> warp)
    : raster_(std::move(raster)), frame_(frame),
      resampler_(sensor_from_frame, raster_.size(), geometry::Kernel::lanczos,
                 through(std::move(warp)))
{
}

std::string ResampledSource::description() const
{
    return raster_.description() + ", in the epipolar frame";
}

std::vector<tiling::Rect> ResampledSource::reading_windows() const
{
    std::vector<tiling::Rect> windows;
    for (int row = 0; row < frame_.rows; row += kWindowPx) {
        for (int col = 0; col < frame_.cols; col += kWindowPx) {
            windows.push_back(intersect({row, col, kWindowPx, kWindowPx}, rect_of(frame_)));
        }
    }
    return windows;
}

void ResampledSource::read(const tiling::Rect& window, tiling::ImageView<double> values)
{
    resampler_.resample(
        window,
        [this](const tiling::Rect& part, tiling::ImageView<double> pixels) {
            raster_.read(part, pixels);
        },
        values);
    if (io::is_floating(raster_.pixel_type())) {
        return;
    }
    const Limits limits = limits_of(raster_.pixel_type());
    for (int r = 0; r < values.rows(); ++r) {
        for (double& value : values.row_span(r)) {
            // Comparisons with NaN are false, so pixels without a value keep it.
            value = std::floor(value + 0.5);
            value = value < limits.least ? limits.least : value;
            value = value > limits.most ? limits.most : value;
        }
    }
}

} // namespace hsgm::pipeline
