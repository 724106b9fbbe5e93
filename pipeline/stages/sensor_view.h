#pragma once

#include "io/raster_source.h"
#include "pipeline/geometry/lattice.h"
#include "pipeline/stages/geometry_search.h"
#include "tiling/image.h"

namespace hsgm::pipeline {

/// One image of a pair while its geometry is sought: its camera, and a reduced copy.
class SensorView {
public:
    /// Opens the image and its model; reads no pixel.
    explicit SensorView(const SensorImage& sensor);

    const SensorImage& sensor() const { return sensor_; }
    tiling::Size size() const { return size_; }
    const geometry::RpcCamera& camera() const { return camera_; }
    /// Adds to the camera's correction.
    void correct(const geometry::ImageCorrection& more);

    /// Reads the image through, keeping means of `factor` x `factor` pixels. Throws InputError
    /// where it has no valid pixel.
    void reduce(int factor);
    const tiling::Image<double>& reduced() const { return reduced_; }
    geometry::RpcCamera reduced_camera() const;
    /// Of the reduced copy's pixels, how many have a value; 1 before there is one.
    double valid_share() const { return valid_share_; }

private:
    SensorView(const SensorImage& sensor, const io::RasterSource& source);

    SensorImage sensor_;
    tiling::Size size_;
    geometry::RpcCamera camera_;
    int factor_ = 1;
    double valid_share_ = 1;
    tiling::Image<double> reduced_;
};

/// By how much an image is reduced: to at most 2048 px a side, and by half at least unless it
/// is small.
int reduction_of(tiling::Size size);

/// An image in memory, drawn into a frame of that size.
tiling::Image<double> draw(const tiling::Image<double>& image,
                           const geometry::Lattice& sensor_from_frame, tiling::Size frame);

} // namespace hsgm::pipeline
