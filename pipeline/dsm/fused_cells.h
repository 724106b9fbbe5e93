#pragma once

#include "pipeline/dsm/cell_block.h"
#include "pipeline/dsm/missing.h"
#include "tiling/image.h"

#include <cstdint>
#include <span>

namespace hsgm::dsm {

/// Some cells as one pair has them.
struct ReasonedCells {
    Cells cells;
    tiling::Image<std::uint8_t> reasons; ///< `Missing` of each
};

/// Takes the heights away that are less confident than `least` (0: none is), and says so.
void remove_uncertain(ReasonedCells& cells, int least);

/// The same cells as several pairs have them together.
struct FusedCells {
    ReasonedCells of;
    tiling::Image<std::uint8_t> pairs; ///< that agree on the height; 0: it has none
};

/// Fuses the heights that pairs give to the same cells. Of those of a cell the weighted median
/// is taken (the lower one of equals), and the weighted mean of all that lie within `gap_m` of
/// it. A pair weighs confidence^2 / (spread + `spread_floor_m`): where pairs disagree, the one
/// that is surer and whose points lie closer together wins.
///
/// Spread becomes that of the points of all pairs that agree about the new height, confidence
/// their weighted mean, points their sum. A cell that no pair has a height for takes the reason
/// of the highest number, which is that of the pair that came furthest.
///
/// Depends on the order of the pairs where weights tie alone: give them in a fixed one. At
/// least one; all of one size.
FusedCells fuse(std::span<const ReasonedCells> pairs, double gap_m, double spread_floor_m);

/// Takes the heights away that are less confident than `least` and that only one pair has:
/// where others agree, each bears the other out.
void remove_uncertain(FusedCells& cells, int least);

} // namespace hsgm::dsm
