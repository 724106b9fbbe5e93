#include "tests/catch.h"

#include "pipeline/stages/height.h"

#include "matcher/refine.h"

#include <algorithm>

using namespace hsgm;
using namespace hsgm::pipeline;

namespace {

constexpr float kNone = matcher::kNodataDisparity;

tiling::Image<float> row_of(std::initializer_list<float> values)
{
    tiling::Image<float> image({1, static_cast<int>(values.size())});
    std::copy(values.begin(), values.end(), image.data());
    return image;
}

} // namespace

TEST_CASE("heights rise with disparity from the reference, and nodata stays nodata")
{
    RectifiedGeometry geometry;
    geometry.height_per_px_m = 0.5;
    geometry.reference_height_m = 100;
    CHECK(heights(row_of({0, 8, -6.5F, kNone}), geometry) == row_of({100, 104, 96.75F, kNone}));
    geometry.height_per_px_m = -2;
    CHECK(heights(row_of({3}), geometry) == row_of({94}));
}

TEST_CASE("depth is focal length times baseline over disparity, where that is above zero")
{
    RectifiedGeometry geometry;
    geometry.focal_px = 1000;
    geometry.baseline_m = 0.5;
    CHECK(depths(row_of({50, 0.25F, 0, -4, kNone}), geometry) ==
          row_of({10, 2000, kNone, kNone, kNone}));
}
