#pragma once

#include "matcher/host/aligned.h"
#include "matcher/host/level_features.h"
#include "matcher/host/level_result.h"
#include "matcher/host/sweep.h"

namespace hsgm::matcher::host {

/// The sums of the last rows that a cost over blocks has added up, and what they are of.
struct BlockRows {
    static constexpr int kNone = -2;

    std::uint64_t features = 0;
    tiling::Rect rect;
    tiling::DisparityRange range;
    int last_row = kNone; ///< the rows up to this one are known
    Buffer<std::uint8_t> differences;
    Buffer<std::uint8_t> sums; ///< of three rows
};

/// Buffers of `matching_costs`, reused from window to window.
struct CostWorkspace {
    Buffer<std::uint8_t> right;
    Buffer<std::uint8_t> padding;
    Buffer<std::uint8_t> prior;
    BlockRows block;
};

/// Matching costs C(p, d) of row `row` of `volume` (docs/algorithm.md, section 3), the prior
/// not yet in, written to `costs` (volume.stride bytes for each pixel of volume.rect).
void matching_cost_row(const LevelFeatures& features, const PairTraits& pair, Cost cost,
                       const CostVolume& volume, int row, std::uint8_t* costs,
                       CostWorkspace& workspace);

/// Adds the prior to a row of costs.
template <typename L>
void add_prior_row(const LevelFeatures& features, const LevelResult<L>& coarser,
                   const CostVolume& volume, int row, std::uint8_t* costs,
                   CostWorkspace& workspace);

} // namespace hsgm::matcher::host
