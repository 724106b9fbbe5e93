#include "pipeline/pairs/pair_choice.h"

#include "io/error.h"
#include "io/raster_source.h"
#include "pipeline/dsm/dsm_grid.h"
#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/geometry/error.h"
#include "pipeline/geometry/footprint.h"
#include "pipeline/geometry/overlap.h"
#include "pipeline/stages/camera_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace hsgm::pipeline {

namespace {

using geometry::MapProjection;
using geometry::RpcGroundCamera;

constexpr double kLeastBaseToHeight = 0.1;
constexpr double kMostBaseToHeight = 1.0;
constexpr double kLeastOverlap = 0.3;
/// Of the frame that is laid only for its figures: coarse, so that it is small.
constexpr double kCoarser = 16;

struct View {
    std::string name;
    tiling::Size size;
    geometry::RpcCamera camera;
};

View view_of(const NamedImage& image)
{
    const io::RasterSource source(image.image);
    return {image.name, source.size(), open_camera(source, image.image.rpc)};
}

MapProjection map_of(const View& view, const geometry::HeightSpan& heights)
{
    const auto middle = view.camera.locate({view.size.cols / 2.0, view.size.rows / 2.0},
                                           (heights.low_m + heights.high_m) / 2);
    if (!middle) {
        throw geometry::GeometryError("the middle of image '" + view.name +
                                      "' meets no ground: its RPC is that of another image");
    }
    return MapProjection::automatic(middle->longitude_deg, middle->latitude_deg);
}

/// Metres that the ray of the image's middle moves for a metre up.
double steepness(const View& view, const RpcGroundCamera& camera, double level_m)
{
    constexpr double kRiseM = 100;
    const geometry::ImagePoint middle{view.size.cols / 2.0, view.size.rows / 2.0};
    const auto low = camera.locate(middle, level_m);
    const auto high = camera.locate(middle, level_m + kRiseM);
    return low && high ? std::hypot(high->x - low->x, high->y - low->y) / kRiseM : 1e9;
}

void judge(PairChoice& pair)
{
    if (pair.base_to_height < kLeastBaseToHeight || pair.base_to_height > kMostBaseToHeight) {
        pair.refusal = fmt::format("its base-to-height ratio is {:.3f}, not {:g} to {:g}",
                                   pair.base_to_height, kLeastBaseToHeight, kMostBaseToHeight);
    } else if (pair.overlap < kLeastOverlap) {
        pair.refusal = fmt::format("the images share {:.0f} % of the smaller one, less than "
                                   "{:.0f} %",
                                   100 * pair.overlap, 100 * kLeastOverlap);
    }
}

/// A coarse frame on the plane at which both share most.
geometry::EpipolarFrame coarse_frame(const View& a, const RpcGroundCamera& left, const View& b,
                                     const RpcGroundCamera& right, double level_m)
{
    geometry::FrameOptions coarse;
    coarse.finer = kCoarser;
    return geometry::make_epipolar_frame(left, a.size, right, b.size,
                                         geometry::ReferenceSurface(level_m), coarse);
}

PairChoice look_at(const View& a, const View& b)
{
    PairChoice pair{a.name, b.name, 0, 0, ""};
    try {
        const auto heights = geometry::heights_of(a.camera.model(), b.camera.model());
        const MapProjection map = map_of(a, heights);
        const RpcGroundCamera left(a.camera, map);
        const RpcGroundCamera right(b.camera, map);
        const auto overlap = geometry::find_overlap(left, a.size, right, b.size, heights);
        const geometry::ReferenceSurface plane(overlap.level_m);
        const double smaller =
            std::min(area_m2(geometry::footprint(left, a.size, plane).corners),
                     area_m2(geometry::footprint(right, b.size, plane).corners));
        pair.overlap = overlap.area_m2 / smaller;
        const auto frame = coarse_frame(a, left, b, right, overlap.level_m);
        pair.base_to_height = frame.px_per_m * frame.gsd_m;
        if (steepness(b, right, overlap.level_m) < steepness(a, left, overlap.level_m)) {
            std::swap(pair.left, pair.right);
        }
        judge(pair);
    } catch (const geometry::GeometryError& error) {
        pair.refusal = error.what();
    }
    return pair;
}

} // namespace

std::vector<PairChoice> choose_pairs(std::vector<NamedImage> images)
{
    std::sort(images.begin(), images.end(),
              [](const NamedImage& a, const NamedImage& b) { return a.name < b.name; });
    std::vector<View> views;
    for (const NamedImage& image : images) {
        views.push_back(view_of(image));
    }
    std::vector<PairChoice> pairs;
    for (std::size_t i = 0; i < views.size(); ++i) {
        for (std::size_t j = i + 1; j < views.size(); ++j) {
            pairs.push_back(look_at(views[i], views[j]));
        }
    }
    return pairs;
}

std::optional<PairGround> ground_of(const io::ImageSpec& left, const io::ImageSpec& right)
{
    const View a = view_of({"left", left});
    const View b = view_of({"right", right});
    try {
        const auto heights = geometry::heights_of(a.camera.model(), b.camera.model());
        const MapProjection map = map_of(a, heights);
        const RpcGroundCamera in_left(a.camera, map);
        const RpcGroundCamera in_right(b.camera, map);
        const auto overlap = geometry::find_overlap(in_left, a.size, in_right, b.size, heights);
        const auto frame = coarse_frame(a, in_left, b, in_right, overlap.level_m);
        return PairGround{map.text(), dsm::cell_for(frame.images_gsd_m)};
    } catch (const geometry::GeometryError&) {
        return std::nullopt;
    }
}

} // namespace hsgm::pipeline
