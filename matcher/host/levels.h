#pragma once

#include "matcher/host/block.h"
#include "matcher/host/tile_output.h"
#include "matcher/matcher.h"

#include <tbb/enumerable_thread_specific.h>

#include <memory>
#include <span>

namespace hsgm::matcher {

/// The coarsest level, solved whole: what the finer levels of every tile start from.
class CoarseSolution {
public:
    virtual ~CoarseSolution() = default;
    /// Bytes it keeps.
    virtual std::int64_t bytes() const = 0;

    MatchStatistics work; ///< that solving it took
};

} // namespace hsgm::matcher

namespace hsgm::matcher::host {

template <typename L>
struct CoarseSolutionOf final : CoarseSolution {
    LevelResult<L> level;
    tiling::Patch<std::uint8_t> tone; ///< for eq. 3
    TileMatch whole;                  ///< the result itself where this is level 0

    std::int64_t bytes() const override;
};

template <typename L>
using Workspaces = tbb::enumerable_thread_specific<BlockWorkspace<L>>;

/// The levels of one match, with path costs of type L.
template <typename L>
class Levels {
public:
    Levels(const PairTraits& pair, const Options& options, const LevelPlan& plan)
        : pair_(pair), options_(options), plan_(plan)
    {
    }

    std::shared_ptr<const CoarseSolution> solve_whole(const LevelImages& images) const;
    /// The empty solution of mode `local`, which has no coarser level.
    std::shared_ptr<const CoarseSolution> no_whole() const
    {
        return std::make_shared<CoarseSolutionOf<L>>();
    }
    TileMatch solve_tile(const tiling::Rect& core, std::span<const LevelImages> images,
                         std::span<const tiling::LevelSupport> support,
                         const CoarseSolution& coarse, Workspaces<L>& workspaces) const;

private:
    LevelJob<L> job(int level, const LevelFeatures& features) const;
    LevelResult<L> solve_windows(const LevelJob<L>& job, const tiling::Rect& windows,
                                 Workspaces<L>& workspaces) const;
    TileMatch solve_windows_to_tile(const LevelJob<L>& job, const tiling::Rect& windows,
                                    const tiling::Rect& core, Workspaces<L>& workspaces) const;
    void add_medians(LevelResult<L>& level) const;
    tiling::DisparityRange range_of(const LevelJob<L>& job, const tiling::Rect& window) const;

    const PairTraits& pair_;
    const Options& options_;
    const LevelPlan& plan_;
    mutable WorkCounter work_;
};

} // namespace hsgm::matcher::host
