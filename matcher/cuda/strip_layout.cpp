#include "matcher/cuda/device.cuh"
#include "matcher/cuda/solve_windows.h"

#include <algorithm>

namespace hsgm::matcher::cuda {

namespace {

// Strips of more rows save little.
constexpr int kMostRows = 16;
constexpr int kWideRows = 4;

std::size_t aligned(std::size_t bytes, std::size_t to = 16)
{
    return (bytes + kGuardBytes + to - 1) / to * to;
}

// The least stride >= `words` that is `skew` more than a multiple of the 32 banks.
int skewed(int words, int skew)
{
    return (words - skew + 31) / 32 * 32 + skew;
}

// Arrays one after the other.
struct Stack {
    std::size_t used = 0;

    std::size_t add(std::size_t bytes)
    {
        const std::size_t begin = used;
        used += aligned(bytes);
        return begin;
    }
};

// Where everything lies with strips of `rows` rows.
StripLayout lay_out(const StripCase& c, int rows, bool parked_in_shared)
{
    StripLayout at;
    at.rows = rows;
    at.words = c.words;
    // Costs and sums of pixels side by side lie in different banks, and so do those of pixels
    // one above the other.
    at.cost_pixel = (c.words + 1) / 2;
    const int cols = c.window_px + 2 * c.halo_px;
    at.cost_row = skewed(cols * at.cost_pixel, c.wide ? 0 : at.cost_pixel % 32);
    at.sum_row = skewed(c.window_px * c.words, c.lanes % 32);
    at.key_row = c.window_px + 2 * c.words;
    at.line_slots = c.window_px + c.halo_px;
    const auto row_count = static_cast<std::size_t>(rows);
    const std::size_t vector = std::size_t(2 * c.words) * c.cell_bytes;
    const int phases = c.paths == 16 ? 2 : 1;
    const int downward = c.paths == 4 ? 1 : (c.paths == 16 ? 7 : 3);
    const int upward = c.paths == 5 ? 0 : downward;
    const std::size_t lines = std::size_t(phases) * std::size_t(at.line_slots) * vector;
    const auto strips = static_cast<std::size_t>((c.window_px + rows - 1) / rows +
                                                 (c.halo_px + rows - 1) / rows + 1);

    Stack shared;
    Stack scratch;
    Stack& near = c.wide ? scratch : shared;
    at.control = shared.add(sizeof(int));
    at.shared_ends[0] = shared.used;
    at.penalties = shared.add(256 * sizeof(unsigned));
    at.shared_ends[1] = shared.used;
    at.keys = near.add(row_count * std::size_t(at.key_row) * sizeof(unsigned));
    at.shared_ends[2] = shared.used;
    at.costs = near.add(row_count * std::size_t(at.cost_row) * sizeof(unsigned));
    at.shared_ends[3] = shared.used;
    at.sums = near.add(row_count * std::size_t(at.sum_row) * sizeof(unsigned));
    at.shared_ends[4] = shared.used;
    at.parked_in_shared = parked_in_shared;
    at.parked = (parked_in_shared ? shared : scratch).add(std::size_t(downward) * lines);
    at.shared_ends[5] = shared.used;
    at.checkpoint_bytes = strips * std::size_t(upward) * lines;
    at.checkpoints = scratch.add(at.checkpoint_bytes);
    if (c.wide) {
        at.wide = scratch.add(std::size_t(c.warps) * 2 * std::size_t(c.words) * 4);
    }
    at.bytes = shared.used;
    at.scratch_bytes = aligned(scratch.used, 256);
    return at;
}

// The highest strips that fit. Directions with steps of two rows need them even.
StripLayout highest(const StripCase& c, bool parked_in_shared)
{
    const int step = c.paths == 16 ? 2 : 1;
    const int most = std::min(kMostRows, c.window_px);
    for (int rows = most / step * step; rows > 0; rows -= step) {
        const StripLayout layout = lay_out(c, rows, parked_in_shared);
        if (layout.bytes <= c.shared_bytes) {
            return layout;
        }
    }
    return {};
}

} // namespace

StripLayout strip_layout(const StripCase& c)
{
    if (c.wide) {
        return lay_out(c, kWideRows, false);
    }
    const StripLayout near = highest(c, true);
    const StripLayout far = highest(c, false);
    // What is parked is written over strip by strip and hardly leaves the second level cache:
    // to put it there pays where it makes fewer strips.
    const auto strips = [&c](const StripLayout& layout) {
        return layout.rows == 0 ? c.window_px + 1
                                : (c.window_px + layout.rows - 1) / layout.rows;
    };
    return strips(far) < strips(near) ? far : near;
}

} // namespace hsgm::matcher::cuda
