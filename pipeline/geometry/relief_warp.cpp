#include "pipeline/geometry/relief_warp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace hsgm::geometry {

namespace {

constexpr int kNodes = 32; // of the lattice along the longer side; maps and rays are smooth
constexpr int kSides = 2;
constexpr int kMaxSteps = 100;
constexpr double kDonePx = 1e-4; // places are rounded to 1/1024 px
constexpr double kRiseM = 100;   // over which the slope of a ray is taken

} // namespace

ReliefWarp::ReliefWarp(const OrthoModel& model, std::shared_ptr<const ElevationGrid> dem)
    : dem_(std::move(dem)), level_m_(model.level_m), margin_px_(model.margin_px),
      right_(model.size.cols), bottom_(model.size.rows)
{
    const int side = std::max(model.size.rows, model.size.cols);
    const int step = std::max(tiling::ceil_div(side, kNodes), 1);
    const auto nodes = [&](int px) {
        return std::max(tiling::ceil_div(px, step) + 1 + 2 * kSides, 4);
    };
    at_ = Lattice(-kSides * step, -kSides * step, step, nodes(model.size.rows),
                  nodes(model.size.cols), 4);
    OrthoModel plain = model;
    plain.margin_px = 0;
    const MapProjection image_map = MapProjection::from_text(model.crs);
    const MapProjection dem_map = MapProjection::from_text(dem_->crs());
    const OrthoGroundCamera camera(plain, {}, image_map);
    for (int i = 0; i < at_.rows(); ++i) {
        for (int j = 0; j < at_.cols(); ++j) {
            const ImagePoint pixel{at_.first_col() + j * at_.step(),
                                   at_.first_row() + i * at_.step()};
            MapPoint place = model.grid.place_of(pixel);
            place.height_m = level_m_;
            const MapPoint there = dem_map.forward(image_map.inverse(place));
            const ImagePoint post = dem_->grid().pixel_of(there.x, there.y);
            const ImagePoint low = camera.project({place.x, place.y, level_m_ - kRiseM});
            const ImagePoint high = camera.project({place.x, place.y, level_m_ + kRiseM});
            const auto node = at_.node(i, j);
            node[0] = post.x;
            node[1] = post.y;
            node[2] = (low.x - high.x) / (2 * kRiseM);
            node[3] = (low.y - high.y) / (2 * kRiseM);
        }
    }
}

ImagePoint ReliefWarp::source_of(ImagePoint levelled) const
{
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const ImagePoint from{levelled.x - margin_px_, levelled.y - margin_px_};
    ImagePoint pixel = from;
    std::array<double, 4> here{};
    for (int step = 0; step < kMaxSteps; ++step) {
        // Beyond the image there is nothing to be read, but the way back may lead outside.
        if (!(pixel.x >= -right_ && pixel.x <= 2 * right_ && pixel.y >= -bottom_ &&
              pixel.y <= 2 * bottom_)) {
            break;
        }
        at_.at(pixel.y, pixel.x, here);
        const double below_m = level_m_ - dem_->height_m({here[0], here[1]});
        const ImagePoint next{from.x - here[2] * below_m, from.y - here[3] * below_m};
        if (!(std::abs(next.x - pixel.x) + std::abs(next.y - pixel.y) > kDonePx)) {
            return next; // NaN, too, where the DEM has no height
        }
        pixel = next;
    }
    return {kNone, kNone};
}

} // namespace hsgm::geometry
