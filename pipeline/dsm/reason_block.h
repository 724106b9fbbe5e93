#pragma once

#include "pipeline/dsm/dsm_grid.h"
#include "pipeline/dsm/missing.h"
#include "tiling/image.h"

#include <cstdint>
#include <vector>

namespace hsgm::dsm {

/// Some cells of a grid while it is found out why those of them that have no height have none:
/// pixels without a disparity leave their reason where they would lie on the ground.
///
/// A cell takes the reason that most of the pixels in it give, the lower number of equals;
/// where there is no pixel in it, those of the cells round it, nearer ones first. So it
/// depends on the set of pixels alone, in whatever order they come, and not on the block.
class ReasonBlock {
public:
    /// A pixel counts for the cells that are no further than `radius` (map units), rounded up
    /// to whole cells.
    ReasonBlock(const DsmGrid& grid, const tiling::Rect& cells, double radius);

    /// What the block can use: places outside change nothing.
    const Bounds& reach() const { return reach_; }
    /// A place at which a pixel without a disparity would lie, and why it has none.
    void add(double x, double y, Missing reason);
    /// The reason of most pixels of a cell (counted from the block's first); nothing
    /// (`Missing::none`) where there is none near.
    Missing most(int row, int col) const;

private:
    static constexpr std::size_t kReasons = kMissingNames.size();
    using Counts = std::array<std::uint32_t, kReasons>;
    void add_counts(int row, int col, Counts& counts) const;

    DsmGrid grid_;
    int margin_;
    tiling::Rect bins_; ///< the block with its margin
    Bounds reach_;
    std::vector<std::uint16_t> counts_; ///< of each reason in each bin; empty before the first
};

/// What a block of `cells` takes at most.
std::int64_t reason_block_bytes(tiling::Size cells);

} // namespace hsgm::dsm
