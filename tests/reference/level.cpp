#include "tests/reference/level.h"

#include "tests/reference/ensure.h"

#include <cstdlib>
#include <utility>

namespace hsgm::reference {

bool has_eight_bits(const Options& options)
{
    return static_cast<int>(rule(options.cost).max) + (options.prior ? 4 : 0) + options.p2 <=
           255;
}

Options with_mode_applied(const Options& options)
{
    Options result = options;
    if (options.mode != Mode::hsgm) {
        result.prior = false;
        result.prune = false;
    }
    if (options.mode == Mode::hsgm_paper) {
        result.halo_px = 0;
    }
    return result;
}

namespace {

/// C(p, .) with the prior, over `range`.
PixelCosts matching_costs(const LevelPair& pair, int row, int col, DisparityRange range,
                          const Options& options, const Level* coarser)
{
    const bool with_prior = options.prior && coarser != nullptr;
    const bool flat = is_flat(pair, row, col);
    PixelCosts costs(range);
    for (int d = range.min; d <= range.max; ++d) {
        costs.at(d) = matching_cost(pair, row, col, d);
        ensure(costs.at(d) <= rule(pair.cost).max, "a matching cost is at most C_max");
        if (with_prior) {
            const std::uint32_t prior = prior_at(coarser->priors(row / 2, col / 2), d);
            const std::uint32_t added = flat ? prior >> 2 : prior >> 4;
            ensure(added <= (flat ? 4u : 1u), "the prior adds at most 4, or 1");
            costs.at(d) += added;
        }
    }
    return costs;
}

/// P2' between pixel (row, col) and its predecessor (row_before, col_before);
/// `entering` says that the path enters its region there.
std::uint32_t penalty_of_jump(const LevelPair& pair, int row, int col, int row_before,
                              int col_before, bool entering, const Options& options,
                              const Level* coarser)
{
    const int here = pair.tone_left(row, col);
    if (options.mode != Mode::hsgm_paper) {
        const int before = pair.tone_left(row_before, col_before);
        return gradient_penalty(options.p1, options.p2, options.p2_half_tone,
                                std::abs(here - before));
    }
    const int before = entering ? coarser->pair.tone_left(row_before / 2, col_before / 2)
                                : pair.tone_left(row_before, col_before);
    return paper_penalty(options.p1, options.p2, std::abs(here - before));
}

/// C(p, .) with the prior over the window's range, for its core and the halo all round.
struct WindowCosts {
    Rect rect;
    Image<PixelCosts> costs;

    const PixelCosts& at(int row, int col) const
    {
        return costs(row - rect.row, col - rect.col);
    }
};

WindowCosts window_costs(const LevelPair& pair, const Window& window, bool whole,
                         const Options& options, const Level* coarser)
{
    WindowCosts result;
    result.rect = tiling::intersect(tiling::expand(window.core, whole ? 0 : options.halo_px),
                                    tiling::rect_of(pair.left.size()));
    result.costs = Image<PixelCosts>(result.rect.size());
    for (int i = 0; i < result.rect.rows; ++i) {
        for (int j = 0; j < result.rect.cols; ++j) {
            result.costs(i, j) = matching_costs(pair, result.rect.row + i, result.rect.col + j,
                                                window.range, options, coarser);
        }
    }
    return result;
}

/// L of direction number `direction` for the core of one window, put into `result`.
void solve_direction(Image<PixelCosts>& result, const Window& window,
                     const WindowCosts& all_matching, std::size_t direction,
                     const LevelPair& pair, const Options& options, bool whole,
                     const Level* coarser)
{
    const Step step = directions(options.paths)[direction];
    const Rect image = tiling::rect_of(pair.left.size());
    const Rect region =
        path_region(window.core, step, whole ? 0 : options.halo_px, pair.left.size());
    const bool eight_bits = has_eight_bits(options);
    const auto p1 = static_cast<std::uint32_t>(options.p1);

    Image<PixelCosts> path(region.size()); // L over the region
    for (int i = 0; i < region.rows; ++i) {
        for (int j = 0; j < region.cols; ++j) {
            // Predecessors first: against the step's direction, rows before columns.
            const int row = step.rows >= 0 ? region.row + i : region.row_end() - 1 - i;
            const int col = step.cols >= 0 ? region.col + j : region.col_end() - 1 - j;
            const int row_before = row - step.rows;
            const int col_before = col - step.cols;
            const PixelCosts& matching = all_matching.at(row, col);

            PixelCosts costs;
            if (region.contains(row_before, col_before)) {
                costs = path_costs(matching,
                                   path(row_before - region.row, col_before - region.col), p1,
                                   penalty_of_jump(pair, row, col, row_before, col_before,
                                                   false, options, coarser));
            } else if (!image.contains(row_before, col_before) || options.mode == Mode::local) {
                costs = matching;
            } else {
                ensure(coarser != nullptr, "a level of windows has a coarser one");
                const PixelCosts& coarse =
                    coarser->paths[direction](row_before / 2, col_before / 2);
                costs = path_costs(
                    matching, coarse_start(coarse, window.range, options.p2, eight_bits), p1,
                    penalty_of_jump(pair, row, col, row_before, col_before, true, options,
                                    coarser));
            }
            for (const std::uint32_t cost : costs.values) {
                ensure(cost <= (eight_bits ? 255u : 65535u), "path costs fit their width");
            }
            if (window.core.contains(row, col)) {
                result(row, col) = costs;
            }
            path(row - region.row, col - region.col) = std::move(costs);
        }
    }
}

std::vector<Window> windows_of(Size size, DisparityRange range, bool whole,
                               const Options& options, const Level* coarser)
{
    if (whole) {
        return {{tiling::rect_of(size), range}};
    }
    std::vector<Window> windows = grid_windows(size, options.window_px);
    for (Window& window : windows) {
        window.range = options.prune && coarser != nullptr
                           ? pruned_range(window.core, coarser->winners, range)
                           : range;
    }
    return windows;
}

} // namespace

Level solve_level(LevelPair pair, DisparityRange range, bool whole,
                  const Options& asked_options, const Level* coarser)
{
    const Options options = with_mode_applied(asked_options);
    Level level;
    level.pair = std::move(pair);
    const Size size = level.pair.left.size();
    level.windows = windows_of(size, range, whole, options, coarser);
    level.window_at = Image<int>(size);
    level.matching = Image<PixelCosts>(size);
    level.paths.assign(directions(options.paths).size(), Image<PixelCosts>(size));
    level.sums = Image<PixelCosts>(size);
    level.winners = Image<int>(size);
    level.priors = Image<PixelCosts>(size);

    for (std::size_t w = 0; w < level.windows.size(); ++w) {
        const Window& window = level.windows[w];
        const WindowCosts matching = window_costs(level.pair, window, whole, options, coarser);
        for (std::size_t r = 0; r < level.paths.size(); ++r) {
            solve_direction(level.paths[r], window, matching, r, level.pair, options, whole,
                            coarser);
        }
        for (int row = window.core.row; row < window.core.row_end(); ++row) {
            for (int col = window.core.col; col < window.core.col_end(); ++col) {
                level.window_at(row, col) = static_cast<int>(w);
                level.matching(row, col) = matching.at(row, col);
                PixelCosts sums(window.range);
                int winner = window.range.min;
                for (int d = window.range.min; d <= window.range.max; ++d) {
                    for (const Image<PixelCosts>& path : level.paths) {
                        sums.at(d) += path(row, col).at(d);
                    }
                    ensure(sums.at(d) <= 65535, "S fits 16 bits");
                    if (sums.at(d) < sums.at(winner)) {
                        winner = d;
                    }
                }
                level.winners(row, col) = winner;
                level.priors(row, col) = prior_of(sums, options.paths);
                level.sums(row, col) = std::move(sums);
            }
        }
    }
    return level;
}

} // namespace hsgm::reference
