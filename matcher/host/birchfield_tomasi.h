#pragma once

#include "matcher/host/aligned.h"
#include "matcher/host/cost_row.h"
#include "matcher/options.h"

#include <cstdint>

namespace hsgm::matcher::host {

/// How far round a pixel a cost sums up the differences of its neighbours.
constexpr int cost_block_radius(Cost cost)
{
    return cost == Cost::birchfield_tomasi ? 1 : 0;
}

/// Largest difference of one pair of pixels, and the one of a pair without two valid pixels.
constexpr int kMostDifference = 26;
constexpr int kHalfDifference = kMostDifference / 2;

/// Differences of the pixels of a row and of their neighbours to the right and left, as far
/// as the image reaches, added up over three columns: row.cols - `before` - `after` sums for
/// the row's pixels but the first `before` and the last `after` (0 or 1). `differences` has
/// room for a row's. Vector code, chosen for the processor at run time.
void difference_sums(const CostRow& row, int before, int after, std::uint8_t* differences,
                     std::uint8_t* sums);

/// Costs from the sums of three rows.
void block_costs(const std::uint8_t* const (&sums)[3], const CostRow& row, std::uint8_t* costs);

} // namespace hsgm::matcher::host
