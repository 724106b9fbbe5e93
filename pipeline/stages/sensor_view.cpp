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

tiling::Size size_of(const geometry::SensorModel& model, const io::RasterSource& source)
{
    return model.ortho() == nullptr ? source.size() : model.ortho()->levelled_size();
}

} // namespace

geometry::SensorModel open_sensor(const io::RasterSource& source, const io::ImageSpec& image,
                                  const PairGeometryOptions& options)
{
    return options.ortho ? geometry::SensorModel(open_ortho(source, image, *options.ortho))
                         : geometry::SensorModel(open_camera(source, image.rpc).model());
}

SensorView::SensorView(const SensorImage& sensor, const PairGeometryOptions& options)
    : SensorView(sensor, options, io::RasterSource(sensor.image))
{
}

SensorView::SensorView(const SensorImage& sensor, const PairGeometryOptions& options,
                       const io::RasterSource& source)
    : sensor_(sensor),
      model_(open_sensor(source, sensor.image, options).model(), sensor.correction),
      warp_(options.ortho ? warp_of(model_, *options.ortho) : nullptr)
{
    size_ = size_of(model_, source);
}

void SensorView::correct(const geometry::ImageCorrection& more)
{
    model_ = model_.corrected(more);
}

ResampledSource SensorView::resampled(const geometry::Lattice& sensor_from_frame,
                                      tiling::Size frame) const
{
    return {io::RasterSource(sensor_.image), sensor_from_frame, frame, warp_};
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

tiling::Size SensorView::reduced_size() const
{
    const geometry::SensorModel model = model_.reduced(factor_);
    return model.ortho() == nullptr ? reduced_.size() : model.ortho()->levelled_size();
}

int reduction_of(tiling::Size size)
{
    const int side = std::max(size.rows, size.cols);
    return std::max(tiling::ceil_div(side, kReducedPx), side > kSmallPx ? 2 : 1);
}

tiling::Image<double> SensorView::draw_reduced(const geometry::Lattice& sensor_from_frame,
                                               tiling::Size frame) const
{
    geometry::PlaceInSource place;
    if (warp_) {
        place = [this](geometry::ImagePoint coarse) {
            const double middle = (factor_ - 1) / 2.0;
            const geometry::ImagePoint fine =
                warp_->source_of({coarse.x * factor_ + middle, coarse.y * factor_ + middle});
            return geometry::ImagePoint{(fine.x - middle) / factor_,
                                        (fine.y - middle) / factor_};
        };
    }
    const geometry::Resampler resampler(sensor_from_frame, reduced_.size(),
                                        geometry::Kernel::lanczos, place);
    tiling::Image<double> result(frame);
    resampler.resample(
        rect_of(frame),
        [this](const tiling::Rect& window, tiling::ImageView<double> pixels) {
            for (int r = 0; r < window.rows; ++r) {
                std::copy_n(reduced_.row(window.row + r) + window.col, window.cols,
                            pixels.row(r));
            }
        },
        result);
    return result;
}

} // namespace hsgm::pipeline
