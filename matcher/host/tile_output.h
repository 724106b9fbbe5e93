#pragma once

#include "matcher/host/block.h"
#include "matcher/matcher.h"

#include <mutex>
#include <vector>

namespace hsgm::matcher::host {

/// Turns the sums of level 0 into a tile's first-pass result. Blocks may come in any order
/// and from several threads: left pixels are disjoint, right-view keys merge by minimum.
class TileOutput {
public:
    TileOutput(const tiling::Rect& core, const LevelFeatures& features, const PairTraits& pair);

    /// Adds the block's pixels that lie in the tile's core. `keys` is a buffer of the worker.
    void add(const BlockSums& sums, Buffer<std::uint32_t>& keys);
    /// The same for the rows [begin, end) of a block alone.
    void add_rows(const BlockSums& sums, int begin, int end, Buffer<std::uint32_t>& keys);

    TileMatch take() { return std::move(result_); }

private:
    void add_pixel(const BlockSums& sums, int row, int col);
    std::uint16_t reasons_of(int row, int col, int winner) const;
    void merge_row(int row, const std::uint32_t* keys, int last_col, int count);

    const LevelFeatures& features_;
    const PairTraits& pair_;
    TileMatch result_;
    std::vector<std::mutex> row_locks_;
};

} // namespace hsgm::matcher::host
