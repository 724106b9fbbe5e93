#include "matcher/host/block.h"

#include "matcher/kernel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace hsgm::matcher::host {

namespace {

using tiling::Rect;

// Runs `body(begin, end)` over rows, on all threads where the block is a whole level.
template <typename Body>
void over_rows(bool spread, const Rect& rect, Body body)
{
    if (!spread) {
        body(rect.row, rect.row_end());
        return;
    }
    tbb::parallel_for(
        tbb::blocked_range<int>(rect.row, rect.row_end(), 8),
        [&](const tbb::blocked_range<int>& rows) { body(rows.begin(), rows.end()); });
}

template <typename L>
CostVolume compute_costs(const LevelJob<L>& job, const Rect& core, tiling::DisparityRange range,
                         BlockWorkspace<L>& workspace)
{
    CostVolume volume;
    volume.rect = intersect(expand(core, job.whole ? 0 : job.options->halo_px),
                            rect_of(job.features->left_size));
    volume.range = range;
    volume.stride = padded_count(range.count());
    const std::size_t pitch = std::size_t(volume.rect.cols) * std::size_t(volume.stride);
    std::uint8_t* costs = workspace.costs.need(pitch * std::size_t(volume.rect.rows));
    volume.data = costs;
    over_rows(job.whole, volume.rect, [&](int begin, int end) {
        CostWorkspace own;
        CostWorkspace& buffers = job.whole ? own : workspace.cost_rows;
        for (int row = begin; row < end; ++row) {
            std::uint8_t* to = costs + std::size_t(row - volume.rect.row) * pitch;
            matching_cost_row(*job.features, *job.pair, job.options->cost, volume, row, to,
                              buffers);
            if (job.options->prior && job.coarser != nullptr) {
                add_prior_row(*job.features, *job.coarser, volume, row, to, buffers);
            }
        }
    });
    return volume;
}

// The core and the halo on the sides that paths of this direction come from.
Rect path_region(const Rect& core, Direction r, int halo_px, const Rect& image)
{
    const int above = r.row > 0 ? halo_px : 0;
    const int below = r.row < 0 ? halo_px : 0;
    const int left = r.col > 0 ? halo_px : 0;
    const int right = r.col < 0 ? halo_px : 0;
    return intersect(tiling::rect_between(core.row - above, core.col - left,
                                          core.row_end() + below, core.col_end() + right),
                     image);
}

Penalties penalties(const Options& options)
{
    Penalties p;
    p.p1 = options.p1;
    for (int a = 0; a < 256; ++a) {
        p.p2[std::size_t(a)] = static_cast<std::uint16_t>(
            options.mode == Mode::hsgm_paper
                ? p2_equation3(options.p1, options.p2, a)
                : p2_gradient(options.p1, options.p2, options.p2_half_tone, a));
    }
    return p;
}

template <typename L>
int unsearched_cost(const Options& options)
{
    return std::min<int>(options.p2 + kUnsearchedMargin, std::numeric_limits<L>::max());
}

// What the paths of a block read and write.
struct BlockVolumes {
    Rect core;
    CostVolume cost;
    std::uint16_t* sums;
};

// One direction of a block.
template <typename L>
SweepJob<L> sweep_job(const LevelJob<L>& job, const BlockVolumes& volumes,
                      const CoarseStart<L>* start, std::vector<LineStore<L>>* lines,
                      std::size_t direction_number)
{
    SweepJob<L> sweep;
    sweep.core = volumes.core;
    sweep.image = rect_of(job.features->left_size);
    sweep.cost = volumes.cost;
    sweep.sums = volumes.sums;
    sweep.tone = &job.features->left_tone;
    sweep.penalties = penalties(*job.options);
    sweep.start = start;
    sweep.coarse_tone = job.coarser_tone;
    sweep.spread_over_threads = job.whole;
    sweep.direction_number = direction_number;
    sweep.direction = directions(job.options->paths)[direction_number];
    sweep.region = path_region(volumes.core, sweep.direction,
                               job.whole ? 0 : job.options->halo_px, sweep.image);
    sweep.first = direction_number == 0;
    sweep.lines = lines != nullptr ? &(*lines)[direction_number] : nullptr;
    return sweep;
}

WindowJob window_job(const LevelJob<std::uint8_t>& job, const BlockVolumes& volumes,
                     const CoarseStart<std::uint8_t>* start,
                     std::vector<LineStore<std::uint8_t>>* lines)
{
    WindowJob window;
    window.core = volumes.core;
    window.image = rect_of(job.features->left_size);
    window.halo_px = job.whole ? 0 : job.options->halo_px;
    window.paths = job.options->paths;
    window.cost = volumes.cost;
    window.p1 = job.options->p1;
    window.penalties = job.penalties;
    window.start = start;
    window.sums = volumes.sums;
    window.lines = lines;
    window.spread_over_threads = job.whole;
    return window;
}

} // namespace

template <typename L>
BlockSums solve_block(const LevelJob<L>& job, const Rect& core, tiling::DisparityRange range,
                      std::vector<LineStore<L>>& lines, BlockWorkspace<L>& workspace)
{
    const CoarseStart<L> start{job.coarser, unsearched_cost<L>(*job.options)};
    const CoarseStart<L>* start_or_none = job.coarser != nullptr ? &start : nullptr;
    const CostVolume cost = compute_costs(job, core, range, workspace);
    const BlockVolumes volumes{
        core, cost, workspace.sums.need(std::size_t(core.area()) * std::size_t(cost.stride))};
    const auto paths = directions(job.options->paths);
    if (job.keep_lines) {
        const StartLines start_lines{job.options->window_px, job.options->halo_px};
        lines.reserve(paths.size());
        for (const Direction r : paths) {
            lines.emplace_back(core, r, start_lines, cost.stride);
        }
    }
    auto* const kept = job.keep_lines ? &lines : nullptr;
    std::size_t done = 0;
    if constexpr (sizeof(L) == 1) {
        if (solves_by_passes<L>(*job.options)) {
            window_paths(window_job(job, volumes, start_or_none, kept), workspace.window);
            done = std::min<std::size_t>(paths.size(), kWindowPaths);
        }
    }
    for (std::size_t i = done; i < paths.size(); ++i) {
        sweep(sweep_job(job, volumes, start_or_none, kept, i), workspace.sweep);
    }
    MatchStatistics work{1, cost.rect.area() * range.count(), 0};
    for (const Direction r : paths) {
        const int halo = job.whole ? 0 : job.options->halo_px;
        work.path_steps +=
            path_region(core, r, halo, rect_of(job.features->left_size)).area() * range.count();
    }
    job.work->add(work);
    return {core, range, cost.stride, volumes.sums};
}

template <typename L>
void keep_block(const LevelJob<L>& job, const BlockSums& sums, BlockResult<L>& result,
                tiling::Patch<std::int16_t>& level_winners, BlockWorkspace<L>& workspace)
{
    result.core = sums.core;
    result.range = sums.range;
    result.stride = sums.stride;
    if (job.keep_prior) {
        result.prior.resize(std::size_t(sums.core.area()) * std::size_t(sums.stride));
    }
    const int cols = sums.core.cols;
    over_rows(job.whole, sums.core, [&](int begin, int end) {
        Buffer<Winner> own;
        Buffer<Winner>& buffer = job.whole ? own : workspace.winners;
        Winner* winners = buffer.need(static_cast<std::size_t>(cols));
        for (int row = begin; row < end; ++row) {
            const SumsRow sums_row{sums.at(row, sums.core.col), cols, sums.stride,
                                   sums.range.count()};
            find_winners(sums_row, winners);
            std::int16_t* to = &level_winners.at(row, sums.core.col);
            for (int i = 0; i < cols; ++i) {
                to[i] = static_cast<std::int16_t>(sums.range.min + winners[i].index);
            }
            if (job.keep_prior) {
                prior_row(sums_row, winners, job.options->paths,
                          result.prior_at(row, sums.core.col));
            }
        }
    });
}

template BlockSums solve_block(const LevelJob<std::uint8_t>&, const Rect&,
                               tiling::DisparityRange, std::vector<LineStore<std::uint8_t>>&,
                               BlockWorkspace<std::uint8_t>&);
template BlockSums solve_block(const LevelJob<std::uint16_t>&, const Rect&,
                               tiling::DisparityRange, std::vector<LineStore<std::uint16_t>>&,
                               BlockWorkspace<std::uint16_t>&);
template void keep_block(const LevelJob<std::uint8_t>&, const BlockSums&,
                         BlockResult<std::uint8_t>&, tiling::Patch<std::int16_t>&,
                         BlockWorkspace<std::uint8_t>&);
template void keep_block(const LevelJob<std::uint16_t>&, const BlockSums&,
                         BlockResult<std::uint16_t>&, tiling::Patch<std::int16_t>&,
                         BlockWorkspace<std::uint16_t>&);

} // namespace hsgm::matcher::host
