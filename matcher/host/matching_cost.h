#pragma once

#include "matcher/host/aligned.h"
#include "matcher/host/level_features.h"
#include "matcher/host/level_result.h"
#include "matcher/host/sweep.h"

namespace hsgm::matcher::host {

/// Buffers of `matching_costs`, reused from window to window.
struct CostWorkspace {
    Buffer<std::uint8_t> right;
    Buffer<std::uint8_t> padding;
    Buffer<std::uint8_t> split;
    Buffer<std::uint8_t> prior;
};

/// Matching costs C(p, d) of row `row` of `volume` (docs/algorithm.md, section 3), the prior
/// not yet in, written to `costs` (volume.stride bytes for each pixel of volume.rect).
void matching_cost_row(const LevelFeatures& features, const PairTraits& pair, Cost cost,
                       const CostVolume& volume, int row, std::uint8_t* costs,
                       CostWorkspace& workspace);

/// Adds the gated prior to a row of costs.
template <typename L>
void add_prior_row(const LevelFeatures& features, const LevelResult<L>& coarser,
                   const CostVolume& volume, int row, std::uint8_t* costs,
                   CostWorkspace& workspace);

} // namespace hsgm::matcher::host
