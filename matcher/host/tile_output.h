#pragma once

#include "matcher/host/level_features.h"
#include "matcher/host/sum_results.h"
#include "matcher/host/sums.h"
#include "matcher/host/winner.h"
#include "matcher/matcher.h"

#include <mutex>
#include <vector>

namespace hsgm::matcher::host {

/// Buffers of a worker for `TileOutput`.
struct OutputWorkspace {
    Buffer<Winner> winners;
    Buffer<float> results;
    Buffer<std::uint8_t> valid;
    RightCandidates candidates;
};

/// Turns the sums of level 0 into a tile's first-pass result. Blocks may come in any order
/// and from several threads: left pixels are disjoint, right-view keys merge by minimum.
class TileOutput {
public:
    TileOutput(const tiling::Rect& core, const LevelFeatures& features, const PairTraits& pair);

    /// Adds the block's pixels that lie in the tile's core.
    void add(const BlockSums& sums, OutputWorkspace& workspace);
    /// The same for the rows [begin, end) of a block alone.
    void add_rows(const BlockSums& sums, int begin, int end, OutputWorkspace& workspace);

    TileMatch take() { return std::move(result_); }

private:
    void add_part(const BlockSums& sums, int row, int col, int cols,
                  OutputWorkspace& workspace);
    void add_reasons(const Winner* winners, int range_min, int row, int col, int cols);
    void merge_right(const SumsRow& part, int range_min, int row, int col,
                     const RightCandidates& candidates);

    const LevelFeatures& features_;
    const PairTraits& pair_;
    TileMatch result_;
    bool right_has_gaps_ = false; ///< pixels without data
    std::vector<std::mutex> row_locks_;
};

} // namespace hsgm::matcher::host
