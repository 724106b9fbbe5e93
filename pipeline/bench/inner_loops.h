#pragma once

#include "matcher/instructions.h"

#include <optional>
#include <vector>

namespace hsgm::bench {

/// Rate of the matcher's inner loops where everything stays in the caches.
struct InnerRate {
    std::optional<matcher::Instructions> instructions; ///< nothing: what the matcher chooses
    int path_bits = 8;                                 ///< of a path cost: 8 or 16
    double cells_per_s = 0;                            ///< pixels x disparities
};

/// Measures costs, eight paths, their sums and the winners of both views: windows of 64 px
/// on their own (mode `local` without a halo), census5x5, 128 disparities, one thread, for
/// every set of instructions and both widths of path costs. Medians of `repeats`.
std::vector<InnerRate> measure_inner_loops(const std::vector<matcher::Instructions>& sets,
                                           int repeats);

} // namespace hsgm::bench
