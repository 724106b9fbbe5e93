#include "pipeline/stages/search_memory.h"

#include "pipeline/stages/sensor_view.h"

#include <algorithm>
#include <cmath>

namespace hsgm::pipeline {

namespace {

// Bytes a pixel. Features: OpenCV's SIFT doubles the sides and keeps eleven float images of
// each octave. Match: the drawn images as doubles and what quick_match states.
constexpr double kReducedPair = 2 * 8;
constexpr double kFeatures = 4 * 4 * 11 * 4.0 / 3 + 2 * 8 + 20;
constexpr double kMatch = 2 * 8 + 60 + 8;
// Sides as geometry_search.cpp has them.
constexpr double kFeatureSide = 1024;
constexpr double kPatchSide = 512;
// Frames on the way to the final one differ a little; and descriptors of features.
constexpr double kMargin = 1.1;
constexpr double kBeside = 16 << 20;

} // namespace

std::int64_t search_bytes(const geometry::PairGeometry& pair)
{
    const geometry::EpipolarFrame& frame = pair.frame;
    const double finer = frame.images_gsd_m / frame.gsd_m; // frame pixels to one of the images'
    const tiling::Size images{static_cast<int>(frame.size.rows / finer) + 1,
                              static_cast<int>(frame.size.cols / finer) + 1};
    const int reduction = reduction_of(images);
    const double reduced = static_cast<double>(images.area()) / reduction / reduction;
    const double side = std::max(images.rows, images.cols) / static_cast<double>(reduction);
    const double coarser = std::ceil(side / kFeatureSide);
    const double range = pair.disparity.count() / finer;
    const double patch = (kPatchSide + 32) * (kPatchSide + 32 + range);
    const double most = std::max(
        {kFeatures * reduced / coarser / coarser, kMatch * reduced, kFeatures * patch});
    return static_cast<std::int64_t>(kBeside + kMargin * (kReducedPair * reduced + most));
}

} // namespace hsgm::pipeline
