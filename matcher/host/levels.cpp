#include "matcher/host/levels.h"

#include "matcher/host/texture.h"
#include "matcher/host/window_range.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace hsgm::matcher::host {

namespace {

using tiling::Rect;

// The window cores that cover `windows`, row by row, clipped to it at the image's edge.
std::vector<Rect> cores(const Rect& windows, int window_px)
{
    std::vector<Rect> result;
    for (int row = windows.row; row < windows.row_end(); row += window_px) {
        for (int col = windows.col; col < windows.col_end(); col += window_px) {
            result.push_back(intersect({row, col, window_px, window_px}, windows));
        }
    }
    return result;
}

template <typename Body>
void over_windows(std::size_t count, Body body)
{
    tbb::parallel_for(std::size_t{0}, count, body, tbb::simple_partitioner());
}

// A whole match's coarsest result copied for one tile of mode `sgm`.
template <typename T>
tiling::Image<T> cut(const tiling::Image<T>& image, const Rect& part)
{
    tiling::Image<T> result(part.size());
    for (int r = 0; r < part.rows; ++r) {
        std::copy_n(image.row(part.row + r) + part.col, part.cols, result.row(r));
    }
    return result;
}

TileMatch cut(const TileMatch& whole, const Rect& core, const PairShape& shape)
{
    TileMatch tile;
    tile.core = core;
    tile.disparity_q8 = cut(whole.disparity_q8, core);
    tile.confidence = cut(whole.confidence, core);
    tile.reasons = cut(whole.reasons, core);
    const Rect seen = intersect(right_reach(core, shape.asked), rect_of(shape.right));
    tile.right_keys.rect = seen;
    tile.right_keys.pixels = cut(whole.right_keys.pixels,
                                 {seen.row - whole.right_keys.rect.row,
                                  seen.col - whole.right_keys.rect.col, seen.rows, seen.cols});
    return tile;
}

} // namespace

template <typename L>
std::int64_t CoarseSolutionOf<L>::bytes() const
{
    std::int64_t sum = tone.rect.area() + 11 * whole.core.area() +
                       2 * (level.winners.rect.area() + level.medians.rect.area());
    for (const auto& block : level.blocks) {
        sum += static_cast<std::int64_t>(block.prior.size());
        for (const auto& line : block.lines) {
            sum += line.bytes();
        }
    }
    return sum;
}

template <typename L>
LevelJob<L> Levels<L>::job(int level, const LevelFeatures& features) const
{
    LevelJob<L> job;
    job.options = &options_;
    job.pair = &pair_;
    job.features = &features;
    job.range = plan_.ranges[static_cast<std::size_t>(level)];
    job.keep_lines = level > 0;
    job.keep_prior = level > 0 && options_.prior;
    job.work = &work_;
    return job;
}

template <typename L>
std::shared_ptr<const CoarseSolution> Levels<L>::solve_whole(const LevelImages& images) const
{
    const int level = plan_.levels() - 1;
    const Rect image = rect_of(plan_.left_sizes.back());
    const auto features = level_features(images, plan_, level, image, pair_, options_);
    LevelJob<L> whole = job(level, features);
    whole.whole = true;
    PenaltyMaps penalties;
    if (solves_by_passes<L>(options_)) {
        penalties = PenaltyMaps(features.left_tone, image, options_);
        whole.penalties = &penalties;
    }
    auto result = std::make_shared<CoarseSolutionOf<L>>();
    auto& block = result->level.blocks.emplace_back();
    BlockWorkspace<L> workspace;
    const BlockSums sums = solve_block(whole, image, whole.range, block.lines, workspace);
    result->work = work_.total();
    result->level.size = image.size();
    result->level.windows = image;
    if (level > 0) {
        result->level.winners = tiling::Patch<std::int16_t>(image);
        keep_block(whole, sums, block, result->level.winners, workspace);
        add_medians(result->level);
        result->tone = features.left_tone;
        return result;
    }
    TileOutput output(image, features, pair_);
    tbb::parallel_for(tbb::blocked_range<int>(0, image.rows, 16),
                      [&](const tbb::blocked_range<int>& rows) {
                          OutputWorkspace own;
                          output.add_rows(sums, rows.begin(), rows.end(), own);
                      });
    result->whole = output.take();
    return result;
}

template <typename L>
tiling::DisparityRange Levels<L>::range_of(const LevelJob<L>& job, const Rect& window) const
{
    return options_.prune && job.coarser != nullptr
               ? window_range(job.coarser->medians, job.coarser->size, window, job.range)
               : job.range;
}

template <typename L>
LevelResult<L> Levels<L>::solve_windows(const LevelJob<L>& job, const Rect& windows,
                                        Workspaces<L>& workspaces) const
{
    const auto blocks = cores(windows, options_.window_px);
    LevelResult<L> result;
    result.size = job.features->left_size;
    result.windows = windows;
    result.window_px = options_.window_px;
    result.blocks.resize(blocks.size());
    result.winners = tiling::Patch<std::int16_t>(windows);
    over_windows(blocks.size(), [&](std::size_t i) {
        auto& kept = result.blocks[i];
        auto& workspace = workspaces.local();
        const BlockSums sums =
            solve_block(job, blocks[i], range_of(job, blocks[i]), kept.lines, workspace);
        keep_block(job, sums, kept, result.winners, workspace);
    });
    add_medians(result);
    return result;
}

template <typename L>
void Levels<L>::add_medians(LevelResult<L>& level) const
{
    if (options_.prune) {
        level.medians = winner_medians(level.winners, level.size);
    }
}

template <typename L>
TileMatch Levels<L>::solve_windows_to_tile(const LevelJob<L>& job, const Rect& windows,
                                           const Rect& core, Workspaces<L>& workspaces) const
{
    const auto blocks = cores(windows, options_.window_px);
    TileOutput output(core, *job.features, pair_);
    over_windows(blocks.size(), [&](std::size_t i) {
        std::vector<LineStore<L>> none;
        auto& workspace = workspaces.local();
        const BlockSums sums =
            solve_block(job, blocks[i], range_of(job, blocks[i]), none, workspace);
        output.add(sums, workspace.output);
    });
    return output.take();
}

template <typename L>
TileMatch Levels<L>::solve_tile(const Rect& core, std::span<const LevelImages> images,
                                std::span<const tiling::LevelSupport> support,
                                const CoarseSolution& coarse, Workspaces<L>& workspaces) const
{
    const auto& top = dynamic_cast<const CoarseSolutionOf<L>&>(coarse);
    if (plan_.windowed_levels() == 0) {
        return cut(top.whole, core, pair_.shape);
    }
    const bool equation3 = options_.mode == Mode::hsgm_paper;
    const LevelResult<L>* coarser = plan_.coarsest_whole ? &top.level : nullptr;
    const tiling::Patch<std::uint8_t>* coarser_tone = equation3 ? &top.tone : nullptr;
    LevelResult<L> kept;
    tiling::Patch<std::uint8_t> kept_tone;
    for (int level = plan_.windowed_levels() - 1;; --level) {
        const auto k = static_cast<std::size_t>(level);
        auto features =
            level_features(images[k], plan_, level, support[k].aggregation, pair_, options_);
        LevelJob<L> level_job = job(level, features);
        level_job.coarser = coarser;
        level_job.coarser_tone = coarser_tone;
        PenaltyMaps penalties;
        if (solves_by_passes<L>(options_)) {
            penalties = PenaltyMaps(features.left_tone, support[k].aggregation, options_);
            level_job.penalties = &penalties;
        }
        if (level == 0) {
            TileMatch tile =
                solve_windows_to_tile(level_job, support[k].windows, core, workspaces);
            tile.work = work_.total();
            return tile;
        }
        kept = solve_windows(level_job, support[k].windows, workspaces);
        coarser = &kept;
        if (equation3) {
            kept_tone = std::move(features.left_tone);
            coarser_tone = &kept_tone;
        }
    }
}

template struct CoarseSolutionOf<std::uint8_t>;
template struct CoarseSolutionOf<std::uint16_t>;
template class Levels<std::uint8_t>;
template class Levels<std::uint16_t>;

} // namespace hsgm::matcher::host
