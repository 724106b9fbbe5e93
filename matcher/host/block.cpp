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
            options.mode == Mode::hsgm_paper ? p2_equation3(options.p1, options.p2, a)
                                             : p2_gradient(options.p1, options.p2, a));
    }
    return p;
}

template <typename L>
int unsearched_cost(const Options& options)
{
    return std::min<int>(options.p2 + kUnsearchedMargin, std::numeric_limits<L>::max());
}

} // namespace

template <typename L>
BlockSums solve_block(const LevelJob<L>& job, const Rect& core, tiling::DisparityRange range,
                      std::vector<LineStore<L>>& lines, BlockWorkspace<L>& workspace)
{
    const Rect image = rect_of(job.features->left_size);
    const CoarseStart<L> start{job.coarser, unsearched_cost<L>(*job.options)};
    SweepJob<L> sweep_job;
    sweep_job.core = core;
    sweep_job.image = image;
    sweep_job.cost = compute_costs(job, core, range, workspace);
    sweep_job.tone = &job.features->left_tone;
    sweep_job.penalties = penalties(*job.options);
    sweep_job.start = job.coarser != nullptr ? &start : nullptr;
    sweep_job.coarse_tone = job.coarser_tone;
    sweep_job.spread_over_threads = job.whole;
    const int stride = sweep_job.cost.stride;
    sweep_job.sums = workspace.sums.need(std::size_t(core.area()) * std::size_t(stride));
    const auto paths = directions(job.options->paths);
    const StartLines start_lines{job.options->window_px, job.options->halo_px};
    lines.reserve(paths.size());
    MatchStatistics work{1, sweep_job.cost.rect.area() * range.count(), 0};
    for (std::size_t i = 0; i < paths.size(); ++i) {
        sweep_job.direction = paths[i];
        sweep_job.direction_number = i;
        sweep_job.region =
            path_region(core, paths[i], job.whole ? 0 : job.options->halo_px, image);
        sweep_job.first = i == 0;
        sweep_job.lines = nullptr;
        if (job.keep_lines) {
            sweep_job.lines = &lines.emplace_back(core, paths[i], start_lines, stride);
        }
        sweep(sweep_job, workspace.sweep);
        work.path_steps += sweep_job.region.area() * range.count();
    }
    job.work->add(work);
    return {core, range, stride, sweep_job.sums};
}

template <typename L>
void keep_block(const LevelJob<L>& job, const BlockSums& sums, BlockResult<L>& result,
                BlockWorkspace<L>& workspace)
{
    result.core = sums.core;
    result.range = sums.range;
    result.stride = sums.stride;
    result.winner = tiling::Image<std::int16_t>(sums.core.size());
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
            std::int16_t* to = result.winner.row(row - sums.core.row);
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
                         BlockResult<std::uint8_t>&, BlockWorkspace<std::uint8_t>&);
template void keep_block(const LevelJob<std::uint16_t>&, const BlockSums&,
                         BlockResult<std::uint16_t>&, BlockWorkspace<std::uint16_t>&);

} // namespace hsgm::matcher::host
