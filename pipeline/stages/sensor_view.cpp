#include "pipeline/stages/sensor_view.h"

#include "io/error.h"
#include "pipeline/geometry/resampler.h"
#include "pipeline/stages/camera_stage.h"
#include "pipeline/stages/reduced_image.h"

#include <algorithm>
#include <cmath>

namespace hsgm::pipeline {

namespace {

constexpr int kReducedPx = 2048;
constexpr int kSmallPx = 640;

geometry::RpcCamera corrected_camera(const io::RasterSource& source, const SensorImage& sensor)
{
    const geometry::RpcCamera camera = open_camera(source, sensor.image.rpc);
    return geometry::RpcCamera(camera.model(), sensor.correction);
}

} // namespace

SensorView::SensorView(const SensorImage& sensor)
    : SensorView(sensor, io::RasterSource(sensor.image))
{
}

SensorView::SensorView(const SensorImage& sensor, const io::RasterSource& source)
    : sensor_(sensor), size_(source.size()), camera_(corrected_camera(source, sensor))
{
}

void SensorView::correct(const geometry::ImageCorrection& more)
{
    camera_ =
        geometry::RpcCamera(camera_.model(), geometry::joined(camera_.correction(), more));
}

void SensorView::reduce(int factor)
{
    FileSource source{io::RasterSource(sensor_.image)};
    factor_ = factor;
    reduced_ = reduced_image(source, factor);
    const auto valid = std::count_if(reduced_.pixels().begin(), reduced_.pixels().end(),
                                     [](double value) { return !std::isnan(value); });
    valid_share_ = static_cast<double>(valid) / static_cast<double>(reduced_.size().area());
    if (valid == 0) {
        throw io::InputError(source.description() +
                             " has no valid pixel: everything is nodata or masked; check the "
                             "nodata value and the mask");
    }
}

geometry::RpcCamera SensorView::reduced_camera() const
{
    // An affine function of the coarse point that does what that of the fine point does.
    geometry::ImageCorrection correction = camera_.correction();
    const double middle = (factor_ - 1) / 2.0;
    const double x_px = correction.x_px + (correction.x_by_x + correction.x_by_y) * middle;
    const double y_px = correction.y_px + (correction.y_by_x + correction.y_by_y) * middle;
    correction.x_px = x_px / factor_;
    correction.y_px = y_px / factor_;
    return geometry::RpcCamera(geometry::reduced(camera_.model(), factor_), correction);
}

int reduction_of(tiling::Size size)
{
    const int side = std::max(size.rows, size.cols);
    return std::max(tiling::ceil_div(side, kReducedPx), side > kSmallPx ? 2 : 1);
}

tiling::Image<double> draw(const tiling::Image<double>& image,
                           const geometry::Lattice& sensor_from_frame, tiling::Size frame)
{
    const geometry::Resampler resampler(sensor_from_frame, image.size(),
                                        geometry::Kernel::lanczos);
    tiling::Image<double> result(frame);
    resampler.resample(
        rect_of(frame),
        [&image](const tiling::Rect& window, tiling::ImageView<double> pixels) {
            for (int r = 0; r < window.rows; ++r) {
                std::copy_n(image.row(window.row + r) + window.col, window.cols, pixels.row(r));
            }
        },
        result);
    return result;
}

} // namespace hsgm::pipeline
