#pragma once

#include "matcher/cuda/solve_job.h"

namespace hsgm::matcher::cuda {

/// Which disparities of a level are searched in which windows.
struct RangeJob {
    Area area; ///< whole windows, clipped to the image
    int window_px = 0;
    int least = 0; ///< of the level
    int count = 0;
    bool prune = false;
    int coarse_rows = 0; ///< of the whole coarser level
    int coarse_cols = 0;
    Plane<const std::int16_t> coarse_winner;
    Window* windows = nullptr; ///< written, row by row
};

/// Lists the windows and their ranges (docs/algorithm.md, section 4).
cudaError_t find_window_ranges(const RangeJob& job, cudaStream_t stream);

/// Windows of an area.
int window_count(const Area& area, int window_px);

} // namespace hsgm::matcher::cuda
