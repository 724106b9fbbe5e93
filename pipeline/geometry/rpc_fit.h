#pragma once

#include "pipeline/geometry/points.h"
#include "pipeline/geometry/rpc_camera.h"

#include <span>

namespace hsgm::geometry {

/// The model with denominators of 1 that fits image points to ground points best, by least
/// squares in the 20 terms of each numerator. For cameras that a polynomial of third degree
/// describes, those far away from a small scene, nothing is lost. Points should fill a box of
/// longitude, latitude and height with at least four places along each axis; throws
/// std::invalid_argument for fewer than 64 points or spans of unequal length.
RpcModel fit_rpc(std::span<const GeodeticPoint> ground, std::span<const ImagePoint> image);

} // namespace hsgm::geometry
