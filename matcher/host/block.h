#pragma once

#include "matcher/host/level_features.h"
#include "matcher/host/level_result.h"
#include "matcher/host/matching_cost.h"
#include "matcher/host/penalty_maps.h"
#include "matcher/host/sums.h"
#include "matcher/host/sweep.h"
#include "matcher/host/tile_output.h"
#include "matcher/host/window_paths.h"
#include "matcher/host/work_counter.h"

#include <optional>

namespace hsgm::matcher::host {

/// What all blocks of one level have in common.
template <typename L>
struct LevelJob {
    const Options* options = nullptr; ///< resolved
    const PairTraits* pair = nullptr;
    const LevelFeatures* features = nullptr;
    tiling::DisparityRange range;                              ///< of the level
    const LevelResult<L>* coarser = nullptr;                   ///< null at the coarsest level
    const tiling::Patch<std::uint8_t>* coarser_tone = nullptr; ///< for eq. 3
    const PenaltyMaps* penalties = nullptr;                    ///< where `solves_by_passes`
    bool whole = false;      ///< one block: the image; its work is spread over the threads
    bool keep_lines = false; ///< a finer level starts its paths here
    bool keep_prior = false; ///< a finer level reads its prior here
    WorkCounter* work = nullptr;
};

/// Buffers of one worker, reused from block to block.
template <typename L>
struct BlockWorkspace {
    Buffer<std::uint8_t> costs;
    Buffer<std::uint16_t> sums;
    Buffer<Winner> winners;
    OutputWorkspace output;
    CostWorkspace cost_rows;
    SweepWorkspace<L> sweep;
    WindowWorkspace window;
};

/// Whether blocks are solved in two passes over 8-bit costs (window_paths.h); the others one
/// direction after the other (sweep.h).
template <typename L>
bool solves_by_passes(const Options& options)
{
    return sizeof(L) == 1 && options.mode != Mode::hsgm_paper;
}

/// Costs, paths and sums of one block. `lines` receives the path costs that the finer level
/// starts from (job.keep_lines).
template <typename L>
BlockSums solve_block(const LevelJob<L>& job, const tiling::Rect& core,
                      tiling::DisparityRange range, std::vector<LineStore<L>>& lines,
                      BlockWorkspace<L>& workspace);

/// Prior of a solved block, as the finer level reads it, and its part of the level's winners.
template <typename L>
void keep_block(const LevelJob<L>& job, const BlockSums& sums, BlockResult<L>& result,
                tiling::Patch<std::int16_t>& level_winners, BlockWorkspace<L>& workspace);

} // namespace hsgm::matcher::host
