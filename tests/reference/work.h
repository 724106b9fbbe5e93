#pragma once

#include "tests/reference/match.h"

#include <cstdint>

namespace hsgm::reference {

/// What a match goes through, counted pixel by pixel from the twin's windows.
struct Work {
    std::int64_t windows = 0;
    std::int64_t cells = 0;      ///< pixels x disparities of cores and halos
    std::int64_t path_steps = 0; ///< the same of every direction's region
};
Work work_of(const MatchResult& twin, const Options& options);

} // namespace hsgm::reference
