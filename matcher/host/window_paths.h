#pragma once

#include "matcher/host/aligned.h"
#include "matcher/host/level_result.h"
#include "matcher/host/penalty_maps.h"
#include "matcher/host/sweep.h"

#include "tiling/rect.h"

#include <cstdint>
#include <vector>

namespace hsgm::matcher::host {

/// At most this many paths, whose steps are at most one.
constexpr int kWindowPaths = 8;
/// Rows at once whose paths along them are shared out among threads.
constexpr int kSharedRows = 32;

/// All paths of one window, or of a level solved whole, whose costs fit 8 bits and whose
/// steps are at most one.
struct WindowJob {
    tiling::Rect core;
    tiling::Rect image; ///< the whole level
    int halo_px = 0;
    int paths = 8; ///< 4, 5 or 8; of 16 the first 8
    CostVolume cost;
    int p1 = 0;
    const PenaltyMaps* penalties = nullptr;
    const CoarseStart<std::uint8_t>* start = nullptr; ///< null: L = C at the window's border
    std::uint16_t* sums = nullptr;                    ///< of `core`, laid out as in sums.h
    std::vector<LineStore<std::uint8_t>>* lines = nullptr; ///< one a direction, or null
    bool spread_over_threads = false; ///< for blocks large enough to share out a row
};

/// Buffers of `window_paths`, reused from window to window.
struct WindowWorkspace {
    Buffer<std::uint8_t> along;
    Buffer<std::uint8_t> apart[3];
    Buffer<std::uint8_t> apart_least[3];
    Buffer<std::uint8_t> start;
};

/// The same integers as one `sweep` for each direction, in two passes over the window
/// instead of one for each direction: down and up, each with the paths that come from the
/// row before and one that runs along the row. So a sum is read and written once a pass, and
/// what a row of pixels needs stays in the first-level cache.
void window_paths(const WindowJob& job, WindowWorkspace& workspace);

/// At most so many bytes of path costs `window_paths` has at a time for a level of `size`
/// solved whole, with `stride` costs a pixel.
std::int64_t whole_level_path_bytes(tiling::Size size, int stride);

} // namespace hsgm::matcher::host
