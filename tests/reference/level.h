#pragma once

#include "tests/reference/paths.h"

#include <vector>

namespace hsgm::reference {

/// Everything about one solved level, nothing thrown away.
struct Level {
    LevelPair pair;
    std::vector<Window> windows;          ///< one, the image, where it is solved whole
    Image<int> window_at;                 ///< which of them holds a pixel in its core
    Image<PixelCosts> matching;           ///< C(p, .) with the prior
    std::vector<Image<PixelCosts>> paths; ///< L_r(p, .), in the order of directions()
    Image<PixelCosts> sums;               ///< S(p, .)
    Image<int> winners;                   ///< d*
    Image<PixelCosts> priors;             ///< q(p, .), what a finer level's prior reads
};

/// Are path costs of these options 8 bits wide?
bool has_eight_bits(const Options& options);

/// What `mode` has no use for is off (prior and pruning are for hsgm, the halo not for
/// hsgm-paper).
Options with_mode_applied(const Options& options);

/// Solves a level (sections 3 to 5) within the disparities `range`, `whole` or by windows.
/// `coarser` is the next coarser level, null for the coarsest.
Level solve_level(LevelPair pair, DisparityRange range, bool whole, const Options& options,
                  const Level* coarser);

} // namespace hsgm::reference
