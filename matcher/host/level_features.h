#pragma once

#include "matcher/host/feature_planes.h"
#include "matcher/matcher.h"

#include <cstdint>

namespace hsgm::matcher::host {

/// Bytes a pixel that a matching cost reads of either image, validity not counted.
int feature_bytes(Cost cost);

/// What matching reads of one level's images, computed once for all windows of a tile.
struct LevelFeatures {
    tiling::Size left_size; ///< of the whole level
    tiling::Size right_size;
    const LevelImages* images = nullptr;
    tiling::Patch<std::uint8_t> left_tone;
    tiling::Patch<std::uint8_t> low_texture;
    FeaturePlanes left;       ///< what the matching cost reads
    FeaturePlanes right;      ///< the same, mirrored
    std::uint64_t number = 0; ///< another one for every call of level_features
};

/// The features of level `level` for matching the pixels of `aggregation`.
/// `images` must hold the image rectangles of that level's support and outlive the result.
LevelFeatures level_features(const LevelImages& images, const LevelPlan& plan, int level,
                             const tiling::Rect& aggregation, const PairTraits& pair,
                             const Options& options);

} // namespace hsgm::matcher::host
