#pragma once

#include "matcher/hmi.h"
#include "matcher/level_plan.h"
#include "matcher/options.h"
#include "matcher/pixel.h"
#include "matcher/statistics.h"
#include "tiling/image.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hsgm::matcher {

/// What a match needs to know about a pair beside its pixels.
struct PairTraits {
    PairShape shape;
    Tone left_tone;
    Tone right_tone;
    std::shared_ptr<const HmiTable> hmi; ///< needed for cost `hmi` only
};

/// The part of one pyramid level's images that a tile reads, in global pixels of the level.
struct LevelImages {
    tiling::Patch<std::uint16_t> left;
    tiling::Patch<std::uint16_t> right;
};

/// First-pass result of a tile, before anything that looks at the right view.
struct TileMatch {
    tiling::Rect core;
    tiling::Image<std::int32_t> disparity_q8; ///< winner with sub-pixel, in 1/256 px
    tiling::Image<std::uint8_t> confidence;   ///< 1..255
    tiling::Image<std::uint16_t> reasons;     ///< nodata, outside, texture, range end
    tiling::Patch<std::uint32_t> right_keys;  ///< S << 16 | (d - asked.min); global columns
                                              ///< of the right image; ~0 where none
    MatchStatistics work;                     ///< that this tile took
};

/// The winning whole disparity of a value in 1/256 px: offsets lie in [-127, 128].
constexpr int winner_of(std::int32_t disparity_q8)
{
    return (disparity_q8 + 127) >> 8;
}

class CoarseSolution;

/// What solving the coarsest level took.
MatchStatistics work_of(const CoarseSolution& coarse);

/// Matches a rectified pair tile by tile; the same bits for every tiling.
///
/// The order of use: `solve_coarse` once, `match_tile` for every tile (in any order, from
/// any number of threads), then `refine` for every piece of the image. All are const and
/// re-entrant; windows of a tile are spread over the threads of the caller's TBB arena.
class Matcher {
public:
    /// Throws std::invalid_argument where options or shape are impossible.
    Matcher(PairTraits pair, const Options& options);

    const LevelPlan& plan() const { return plan_; }
    const Options& options() const { return options_; }
    const PairTraits& pair() const { return pair_; }

    /// Solves the coarsest level whole, from its complete images. In mode `local`, which
    /// has no such level, an empty solution. Peak memory: `coarse_bytes()`.
    std::shared_ptr<const CoarseSolution>
    solve_coarse(tiling::ImageView<const std::uint16_t> left,
                 tiling::ImageView<const std::uint16_t> right) const;

    /// What a tile depends on, level by level; images outside it are never read.
    std::vector<tiling::LevelSupport> support(const tiling::Rect& core) const;

    /// Matches the pixels of `core`. `images[k]` must hold at least the image rectangles of
    /// `support(core)[k]`, one entry for each windowed level.
    TileMatch match_tile(const tiling::Rect& core, std::span<const LevelImages> images,
                         const CoarseSolution& coarse) const;

    /// Upper bound of what `solve_coarse` takes at its peak, images not counted.
    std::int64_t coarse_bytes() const;
    /// Upper bound of what `match_tile` takes for a square tile of this side with `threads`
    /// threads at work on it: levels' results, window buffers and the images of its support.
    std::int64_t tile_bytes(int tile_size_px, int threads) const;

private:
    PairTraits pair_;
    Options options_;
    LevelPlan plan_;
    struct Workers;
    std::shared_ptr<Workers> workers_;
};

/// The table for cost `hmi`, from the complete images of the level that `hmi_level(shape)`
/// names. Deterministic; made once a pair.
std::shared_ptr<const HmiTable> solve_hmi_table(const PairTraits& pair, const Options& options,
                                                tiling::ImageView<const std::uint16_t> left,
                                                tiling::ImageView<const std::uint16_t> right);

/// Name of the vector instructions that the matcher uses on this processor.
const char* vector_instructions();

/// The level whose images `solve_hmi_table` wants: the coarsest of mode `hsgm`, levels auto.
int hmi_level(const PairShape& shape);

} // namespace hsgm::matcher
