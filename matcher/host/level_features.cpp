#include "matcher/host/level_features.h"

#include "matcher/host/census.h"
#include "matcher/host/texture.h"

#include <algorithm>
#include <vector>

namespace hsgm::matcher::host {

namespace {

using tiling::Patch;
using tiling::Rect;
using tiling::Size;

void write_validity(const Patch<std::uint16_t>& image, FeaturePlanes& planes)
{
    const Rect& rect = planes.rect();
    std::vector<std::uint8_t> valid(static_cast<std::size_t>(rect.cols));
    for (int row = rect.row; row < rect.row_end(); ++row) {
        std::transform(&image.at(row, rect.col), &image.at(row, rect.col) + rect.cols,
                       valid.begin(),
                       [](std::uint16_t pixel) { return is_valid(pixel) ? 255 : 0; });
        planes.write_validity(row, valid.data());
    }
}

void write_tones(const Patch<std::uint16_t>& image, Tone tone, int plane, FeaturePlanes& planes)
{
    const Rect& rect = planes.rect();
    std::vector<std::uint8_t> values(static_cast<std::size_t>(rect.cols));
    for (int row = rect.row; row < rect.row_end(); ++row) {
        tone_run(tone, &image.at(row, rect.col), rect.cols, values.data());
        planes.write(plane, row, values.data());
    }
}

FeaturePlanes cost_planes(const Patch<std::uint16_t>& image, Size full, const Rect& rect,
                          Tone tone, Cost cost, bool mirrored)
{
    const CostTraits radius = traits(cost);
    const CensusShape shape{radius.radius_rows, radius.radius_cols};
    FeaturePlanes planes(rect, cost == Cost::hmi ? 1 : shape.planes(), mirrored);
    if (rect.empty()) {
        return planes;
    }
    if (cost == Cost::hmi) {
        write_tones(image, tone, 0, planes);
    } else {
        census(image, full, shape, planes);
    }
    write_validity(image, planes);
    return planes;
}

} // namespace

LevelFeatures level_features(const LevelImages& images, const LevelPlan& plan, int level,
                             const Rect& aggregation, const PairTraits& pair,
                             const Options& options)
{
    const auto k = static_cast<std::size_t>(level);
    LevelFeatures f;
    f.left_size = plan.left_sizes[k];
    f.right_size = plan.right_sizes[k];
    f.images = &images;
    f.left_tone = tones(images.left, pair.left_tone);
    f.low_texture = low_texture(images.left, f.left_tone, aggregation);
    const Rect seen =
        intersect(right_reach(aggregation, plan.ranges[k]), rect_of(f.right_size));
    f.left =
        cost_planes(images.left, f.left_size, aggregation, pair.left_tone, options.cost, false);
    f.right =
        cost_planes(images.right, f.right_size, seen, pair.right_tone, options.cost, true);
    return f;
}

} // namespace hsgm::matcher::host
