#pragma once

#include "pipeline/geometry/tie_points.h"

#include <vector>

namespace hsgm::geometry::samples {

/// Moves the right point of each to where a window of 2 x `radius_px` + 1 round the left one
/// fits best (cross-correlation maximum to a fraction of a pixel); drops those whose
/// correlation stays below `least_correlation`, whose shift across the rows is not known to
/// `most_deviation_px` (the standard deviation that least squares give), that would move by
/// more than 1.5 px, or whose window is not whole.
std::vector<TiePoint> match_windows(const std::vector<TiePoint>& points, const FramePatch& left,
                                    const FramePatch& right, int radius_px = 7,
                                    double least_correlation = 0.8,
                                    double most_deviation_px = 1.0);

} // namespace hsgm::geometry::samples
