#include "pipeline/stages/height.h"

#include "matcher/refine.h"

#include <algorithm>

namespace hsgm::pipeline {

namespace {

using matcher::kNodataDisparity;

template <typename Function>
tiling::Image<float> map_valid(const tiling::Image<float>& disparity_px, Function function)
{
    tiling::Image<float> result(disparity_px.size(), kNodataDisparity);
    const auto from = disparity_px.pixels();
    std::transform(from.begin(), from.end(), result.data(), [&](float d) {
        return d == kNodataDisparity ? kNodataDisparity : function(d);
    });
    return result;
}

} // namespace

tiling::Image<float> heights(const tiling::Image<float>& disparity_px,
                             const RectifiedGeometry& geometry)
{
    const double reference = geometry.reference_height_m;
    const double per_px = geometry.height_per_px_m.value();
    return map_valid(disparity_px, [=](float d) {
        return static_cast<float>(reference + static_cast<double>(d) * per_px);
    });
}

tiling::Image<float> depths(const tiling::Image<float>& disparity_px,
                            const RectifiedGeometry& geometry)
{
    const double focal_baseline = geometry.focal_px.value() * geometry.baseline_m.value();
    return map_valid(disparity_px, [=](float d) {
        return d > 0 ? static_cast<float>(focal_baseline / static_cast<double>(d))
                     : kNodataDisparity;
    });
}

} // namespace hsgm::pipeline
