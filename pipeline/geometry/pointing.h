#pragma once

#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/geometry/rpc_camera.h"
#include "pipeline/geometry/tie_points.h"

#include <span>
#include <string>
#include <vector>

namespace hsgm::geometry {

/// How the pointing of the right image is mended: by a shift across the epipolar lines, by
/// one that also changes linearly over the image, or by the better one.
enum class PointingModel { automatic, shift, affine };

/// What tie points tell about the pointing of the right image against the left one. Only the
/// part across the epipolar lines shows in a pair; along them it looks like height.
struct Pointing {
    ImageCorrection correction; ///< to be added to the right image's points
    bool affine = false;
    ImagePoint across;   ///< unit vector in the right image, across its epipolar lines
    int points = 0;      ///< tie points looked at
    int inliers = 0;     ///< those that agree
    double shift_px = 0; ///< along `across`, in the middle of the inliers
    /// Root mean square of the inliers' distances from their epipolar lines, in pixels of the
    /// right image, without and with the correction.
    double rms_before_px = 0;
    double rms_after_px = 0;
    /// Why one should look at the result; empty where nothing is suspicious.
    std::vector<std::string> warnings;
};

/// Estimates the correction from tie points of which many may be wrong: the densest cluster of
/// distances, then least squares on those near it, again and again. `inlier` (of the size of
/// `points`, or null) tells which agree. Throws GeometryError with figures where too few tie
/// points agree (20) or they do not agree well (1 px): pointing cannot be trusted.
Pointing estimate_pointing(const EpipolarFrame& frame, std::span<const TiePoint> points,
                           tiling::Size right_size, PointingModel model,
                           std::vector<bool>* inlier = nullptr);

/// The correction that does first one, then the other.
ImageCorrection joined(const ImageCorrection& first, const ImageCorrection& then);

/// What a pair knows that was corrected by a rough shift first: the later finding, told
/// against the uncorrected image.
Pointing joined(const Pointing& rough, const Pointing& then);

} // namespace hsgm::geometry
