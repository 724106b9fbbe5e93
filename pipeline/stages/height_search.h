#pragma once

#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/geometry/overlap.h"
#include "tiling/image.h"

#include <functional>
#include <string>

namespace hsgm::pipeline {

/// A frame with both images drawn into it.
struct DrawnPair {
    geometry::EpipolarFrame frame;
    tiling::Image<double> left;
    tiling::Image<double> right;
};

struct HeightSearch {
    geometry::HeightSpan heights;
    std::string warning; ///< why they are no more than a guess; empty: they are not
};

/// The heights that ground may have: what the reduced images (one of their pixels is
/// `reduction` of the images') match at, and what is too small to show in them. `draw` makes a
/// pair for a level and the heights round it. Searches `first`, and on from where that ends in
/// the middle of something; what lies apart from the ground there, as clouds match, widens
/// nothing.
HeightSearch
search_heights(geometry::HeightSpan first, int reduction,
               const std::function<DrawnPair(double level_m, geometry::HeightSpan)>& draw);

} // namespace hsgm::pipeline
