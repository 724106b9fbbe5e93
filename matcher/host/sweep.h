#pragma once

#include "matcher/host/aligned.h"
#include "matcher/host/coarse_start.h"
#include "matcher/host/level_result.h"
#include "tiling/image.h"

#include <array>
#include <cstdint>

namespace hsgm::matcher::host {

/// Matching costs of the pixels of `rect`, `stride` bytes a pixel; disparities beyond the
/// range are padded with 255, which no minimum ever takes.
struct CostVolume {
    tiling::Rect rect;
    tiling::DisparityRange range;
    int stride = 0;
    const std::uint8_t* data = nullptr;

    const std::uint8_t* at(int row, int col) const
    {
        return data + (std::size_t(row - rect.row) * std::size_t(rect.cols) +
                       std::size_t(col - rect.col)) *
                          std::size_t(stride);
    }
};

/// P1, and P2' for every tone difference.
struct Penalties {
    int p1 = 0;
    std::array<std::uint16_t, 256> p2{};
};

/// One direction of one block: path costs over `region`, sums over `core`.
template <typename L>
struct SweepJob {
    tiling::Rect region; ///< the core and the halo on the sides the path comes from
    tiling::Rect core;
    tiling::Rect image; ///< the whole level
    Direction direction{};
    std::size_t direction_number = 0;
    CostVolume cost;
    const tiling::Patch<std::uint8_t>* tone =
        nullptr; ///< left image, covers `region` and 1 step
    Penalties penalties;
    const CoarseStart<L>* start = nullptr; ///< null: paths start afresh at the region's border
    const tiling::Patch<std::uint8_t>* coarse_tone =
        nullptr;                      ///< eq. 3: compare with this at the start
    std::uint16_t* sums = nullptr;    ///< of `core`, stride as the costs
    bool first = false;               ///< the first direction stores its sums, others add
    LineStore<L>* lines = nullptr;    ///< null where no finer level reads
    bool spread_over_threads = false; ///< for blocks large enough to share out a row
};

/// Buffers of a sweep, reused from one to the next by the same worker.
template <typename L>
struct SweepWorkspace {
    Buffer<L> rows;
    Buffer<L> least;
    Buffer<L> start;
};

/// Runs the recurrence of eq. 1 over the job's region (docs/algorithm.md, section 4).
/// Exact as long as C_max + prior + P2 fits L. Vector code, chosen for the processor at run
/// time.
void sweep(const SweepJob<std::uint8_t>& job, SweepWorkspace<std::uint8_t>& workspace);
void sweep(const SweepJob<std::uint16_t>& job, SweepWorkspace<std::uint16_t>& workspace);

} // namespace hsgm::matcher::host
