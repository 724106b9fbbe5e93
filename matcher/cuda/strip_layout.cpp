#include "matcher/cuda/device.cuh"
#include "matcher/cuda/solve_windows.h"

#include <algorithm>

namespace hsgm::matcher::cuda {

namespace {

// Strips of more rows save little.
constexpr int kMostRows = 16;

std::size_t aligned(std::size_t bytes)
{
    return (bytes + kGuardBytes + 15) / 16 * 16;
}

// The least stride >= `words` that is `skew` more than a multiple of the 32 banks.
int skewed(int words, int skew)
{
    return (words - skew + 31) / 32 * 32 + skew;
}

struct Case {
    int words;
    int lanes;
    int window_px;
    int halo_px;
    int paths;
    std::size_t cell_bytes;
};

// Where everything lies with strips of `rows` rows.
StripLayout lay_out(const Case& c, int rows, bool parked_in_shared)
{
    StripLayout at;
    at.rows = rows;
    at.words = c.words;
    // Pixels of a warp lie side by side; each brings `lanes` words at once.
    at.pixel_stride = c.words + (c.lanes < 32 ? c.lanes : 0);
    const int cols = c.window_px + 2 * c.halo_px;
    at.cost_row = skewed(cols * at.pixel_stride, c.lanes % 32);
    at.sum_row = skewed(c.window_px * at.pixel_stride, c.lanes % 32);
    at.key_row = c.window_px + 2 * c.words;
    at.line_slots = c.window_px + c.halo_px;
    const std::size_t vector = std::size_t(2 * c.words) * c.cell_bytes;
    const int phases = c.paths == 16 ? 2 : 1;
    const int downward = c.paths == 4 ? 1 : (c.paths == 16 ? 7 : 3);
    const int upward = c.paths == 5 ? 0 : downward;
    const std::size_t lines = std::size_t(phases) * std::size_t(at.line_slots) * vector;
    const std::size_t parked = aligned(std::size_t(downward) * lines);

    at.control = 0;
    at.penalties = aligned(sizeof(int));
    at.keys = at.penalties + aligned(256 * sizeof(unsigned));
    at.costs = at.keys + aligned(std::size_t(rows) * std::size_t(at.key_row) * 4);
    at.sums = at.costs + aligned(std::size_t(rows) * std::size_t(at.cost_row) * 4);
    at.parked = at.sums + aligned(std::size_t(rows) * std::size_t(at.sum_row) * 4);
    at.bytes = at.parked + (parked_in_shared ? parked : 0);
    at.parked_in_shared = parked_in_shared;

    const auto strips = static_cast<std::size_t>((c.window_px + rows - 1) / rows +
                                                 (c.halo_px + rows - 1) / rows + 1);
    at.checkpoint_bytes = strips * std::size_t(upward) * lines;
    at.checkpoints = 0;
    at.scratch_bytes = aligned(at.checkpoint_bytes);
    if (!parked_in_shared) {
        at.parked = at.scratch_bytes;
        at.scratch_bytes += parked;
    }
    at.scratch_bytes = (at.scratch_bytes + 255) / 256 * 256;
    return at;
}

// The highest strips that fit. Directions with steps of two rows need them even.
StripLayout highest(const Case& c, std::size_t shared_bytes, bool parked_in_shared)
{
    const int step = c.paths == 16 ? 2 : 1;
    const int most = std::min(kMostRows, c.window_px);
    for (int rows = most / step * step; rows > 0; rows -= step) {
        const StripLayout layout = lay_out(c, rows, parked_in_shared);
        if (layout.bytes <= shared_bytes) {
            return layout;
        }
    }
    return {};
}

} // namespace

StripLayout strip_layout(int words, int lanes, int window_px, int halo_px, int paths,
                         std::size_t cell_bytes, std::size_t shared_bytes)
{
    const Case c{words, lanes, window_px, halo_px, paths, cell_bytes};
    const StripLayout near = highest(c, shared_bytes, true);
    const StripLayout far = highest(c, shared_bytes, false);
    // Parking in device memory pays where it makes strips half as high again.
    return 2 * far.rows >= 3 * near.rows ? far : near;
}

} // namespace hsgm::matcher::cuda
