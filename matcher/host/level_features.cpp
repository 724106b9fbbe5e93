#include "matcher/host/level_features.h"

#include "matcher/host/census.h"
#include "matcher/host/texture.h"

namespace hsgm::matcher::host {

LevelFeatures level_features(const LevelImages& images, const LevelPlan& plan, int level,
                             const tiling::Rect& aggregation, const PairTraits& pair,
                             const Options& options)
{
    const auto k = static_cast<std::size_t>(level);
    const CostTraits cost = traits(options.cost);
    LevelFeatures f;
    f.left_size = plan.left_sizes[k];
    f.right_size = plan.right_sizes[k];
    f.images = &images;
    f.left_tone = tones(images.left, pair.left_tone);
    f.low_texture = low_texture(images.left, f.left_tone, aggregation);
    const tiling::Rect seen =
        intersect(right_reach(aggregation, plan.ranges[k]), rect_of(f.right_size));
    if (options.cost == Cost::hmi) {
        f.right_tone = tones(images.right, pair.right_tone);
    } else {
        f.left_census =
            census(images.left, f.left_size, cost.radius_rows, cost.radius_cols, aggregation);
        f.right_census =
            census(images.right, f.right_size, cost.radius_rows, cost.radius_cols, seen);
    }
    return f;
}

} // namespace hsgm::matcher::host
