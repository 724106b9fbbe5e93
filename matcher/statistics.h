#pragma once

#include <cstdint>

namespace hsgm::matcher {

/// What a match worked through: exact counts, the same on every machine and for any number
/// of threads. They are of the work done, so smaller tiles, which repeat the windows at their
/// borders, count more of it.
struct MatchStatistics {
    std::int64_t windows = 0;    ///< solved; a level that is solved whole counts as one
    std::int64_t cells = 0;      ///< pixels x disparities whose matching cost was computed:
                                 ///< cores and halos, over the stored range of each window
    std::int64_t path_steps = 0; ///< evaluations of eq. 1: cells that a path went over, summed
                                 ///< over all directions

    MatchStatistics& operator+=(const MatchStatistics& other)
    {
        windows += other.windows;
        cells += other.cells;
        path_steps += other.path_steps;
        return *this;
    }
    bool operator==(const MatchStatistics&) const = default;
};

} // namespace hsgm::matcher
