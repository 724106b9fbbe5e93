#pragma once

#include "io/raster_source.h"
#include "pipeline/geometry/lattice.h"
#include "pipeline/stages/geometry_search.h"
#include "pipeline/stages/resampled_source.h"
#include "tiling/image.h"

#include <memory>

namespace hsgm::pipeline {

/// One image of a pair while its geometry is sought: its camera, and a reduced copy.
class SensorView {
public:
    /// Opens the image and its model; reads no pixel.
    SensorView(const SensorImage& sensor, const PairGeometryOptions& options);

    const SensorImage& sensor() const { return sensor_; }
    /// Of the image as its model speaks of it.
    tiling::Size size() const { return size_; }
    const geometry::SensorModel& model() const { return model_; }
    /// How it was taken, seen from a map.
    std::unique_ptr<geometry::GroundCamera> camera(const geometry::MapProjection& map) const
    {
        return model_.over(map);
    }
    /// Adds to the model's correction.
    void correct(const geometry::ImageCorrection& more);
    /// The image at full resolution, drawn into a frame on the way. `sensor_from_frame` must
    /// outlive the result.
    ResampledSource resampled(const geometry::Lattice& sensor_from_frame,
                              tiling::Size frame) const;

    /// Reads the image through, keeping means of `factor` x `factor` pixels. Throws InputError
    /// where it has no valid pixel.
    void reduce(int factor);
    tiling::Size reduced_size() const;
    std::unique_ptr<geometry::GroundCamera>
    reduced_camera(const geometry::MapProjection& map) const
    {
        return model_.reduced(factor_).over(map);
    }
    /// The reduced image, drawn into a frame of that size.
    tiling::Image<double> draw_reduced(const geometry::Lattice& sensor_from_frame,
                                       tiling::Size frame) const;
    /// Of the reduced copy's pixels, how many have a value; 1 before there is one.
    double valid_share() const { return valid_share_; }

private:
    SensorView(const SensorImage& sensor, const PairGeometryOptions& options,
               const io::RasterSource& source);

    SensorImage sensor_;
    tiling::Size size_;
    geometry::SensorModel model_;
    std::shared_ptr<const geometry::ReliefWarp> warp_;
    int factor_ = 1;
    double valid_share_ = 1;
    tiling::Image<double> reduced_;
};

/// By how much an image is reduced: to at most 2048 px a side, and by half at least unless it
/// is small.
int reduction_of(tiling::Size size);

} // namespace hsgm::pipeline
