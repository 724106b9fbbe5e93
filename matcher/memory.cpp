#include "matcher/memory.h"

#include "matcher/host/level_features.h"
#include "matcher/kernel.h"

#include <algorithm>
#include <vector>

namespace hsgm::matcher {

namespace {

using tiling::LevelSupport;
using tiling::Rect;

constexpr std::int64_t kImageBytes = 2 + 1 + 1 + 1; // pixels, tone, texture gate, validity
constexpr std::int64_t kRightBytes = 2 + 1;         // pixels, validity
constexpr std::int64_t kFirstPassBytes = 4 + 1 + 2; // disparity, confidence, reasons
constexpr std::int64_t kKeyBytes = 4;

std::int64_t path_bytes(const Options& options)
{
    return options.fits_8_bits() ? 1 : 2;
}

// What a level keeps for the next finer one: winners and their medians, prior and start lines.
std::int64_t kept_bytes(const Rect& windows, int count, const Options& options)
{
    const std::int64_t cells = windows.area() * padded_count(count);
    const std::int64_t prior = options.prior ? cells : 0;
    // Two lines of a pitch of window / 2 for diagonals, one for the others; two pitches more
    // for windows cut by the edge.
    const std::int64_t lines =
        cells * options.paths * path_bytes(options) * 4 / std::max(options.window_px, 1);
    return (2 + 2) * windows.area() + prior + lines;
}

std::int64_t feature_bytes(const LevelSupport& s, Cost cost)
{
    const std::int64_t of_cost = host::feature_bytes(cost);
    return s.left_image.area() * (kImageBytes + of_cost) +
           s.right_image.area() * (kRightBytes + of_cost);
}

std::int64_t worker_bytes(const Options& options, int count)
{
    const std::int64_t stride = padded_count(count);
    const std::int64_t side = options.window_px + 2 * options.halo_px;
    const std::int64_t rows = options.paths == 16 ? 3 : 2;
    return side * side * stride +                                             // costs
           2 * std::int64_t{options.window_px} * options.window_px * stride + // sums
           rows * side * (stride + 16) * path_bytes(options) + (1 << 16);
}

// A tile in the middle of the image that starts just before a window's border has the largest
// support.
Rect worst_tile(const LevelPlan& plan, int window, int tile_size_px)
{
    const tiling::Size full = plan.left_sizes.front();
    const int rows = tile_size_px == 0 ? full.rows : std::min(tile_size_px, full.rows);
    const int cols = tile_size_px == 0 ? full.cols : std::min(tile_size_px, full.cols);
    const auto off_grid = [window](int whole, int part) {
        return part == whole
                   ? 0
                   : std::min((whole - part) / 2 / window * window + window - 1, whole - part);
    };
    return {off_grid(full.rows, rows), off_grid(full.cols, cols), rows, cols};
}

std::int64_t image_bytes(const std::vector<LevelSupport>& levels)
{
    std::int64_t bytes = 0;
    for (const LevelSupport& s : levels) {
        bytes += 2 * (s.left_image.area() + s.right_image.area());
    }
    return bytes;
}

std::int64_t result_bytes(const Rect& core, const LevelPlan& plan)
{
    const Rect seen =
        intersect(right_reach(core, plan.ranges.front()), rect_of(plan.right_sizes.front()));
    return core.area() * kFirstPassBytes + seen.area() * kKeyBytes;
}

} // namespace

std::int64_t Matcher::coarse_bytes() const
{
    if (!plan_.coarsest_whole) {
        return 0;
    }
    const tiling::Size size = plan_.left_sizes.back();
    const int count = plan_.ranges.back().count();
    const std::int64_t cells = size.area() * padded_count(count);
    const std::int64_t rows = options_.paths == 16 ? 3 : 2;
    const std::int64_t path_rows =
        rows * size.cols * std::int64_t{padded_count(count) + 16} * path_bytes(options_);
    const LevelSupport whole{rect_of(size), rect_of(size), rect_of(size),
                             rect_of(plan_.right_sizes.back())};
    const std::int64_t outputs =
        plan_.levels() == 1
            ? size.area() * kFirstPassBytes + plan_.right_sizes.back().area() * kKeyBytes
            : kept_bytes(rect_of(size), count, options_);
    return cells * (1 + 2) + path_rows + feature_bytes(whole, options_.cost) + outputs;
}

std::int64_t coarse_kept_bytes(const Matcher& matcher)
{
    const LevelPlan& plan = matcher.plan();
    if (!plan.coarsest_whole || plan.levels() == 1) {
        return matcher.coarse_bytes(); // where it is the result itself, all of it stays
    }
    const tiling::Size size = plan.left_sizes.back();
    return kept_bytes(rect_of(size), plan.ranges.back().count(), matcher.options()) +
           size.area(); // the tone
}

std::int64_t Matcher::tile_bytes(int tile_size_px, int threads) const
{
    const Rect core = worst_tile(plan_, options_.window_px, tile_size_px);
    const auto levels = support(core);
    std::int64_t most = 0;
    std::int64_t coarser_kept = 0;
    for (int level = plan_.windowed_levels() - 1; level >= 0; --level) {
        const auto k = static_cast<std::size_t>(level);
        const LevelSupport& s = levels[k];
        const std::int64_t kept =
            level > 0 ? kept_bytes(s.windows, plan_.ranges[k].count(), options_) : 0;
        most = std::max(most, feature_bytes(s, options_.cost) + kept + coarser_kept);
        coarser_kept = kept;
    }
    const std::int64_t workers =
        plan_.windowed_levels() == 0
            ? 0
            : threads * worker_bytes(options_, plan_.ranges.front().count());
    return image_bytes(levels) + most + result_bytes(core, plan_) + workers;
}

std::int64_t waiting_tile_bytes(const Matcher& matcher, int tile_size_px)
{
    const LevelPlan& plan = matcher.plan();
    const Rect core = worst_tile(plan, matcher.options().window_px, tile_size_px);
    return std::max(image_bytes(matcher.support(core)), result_bytes(core, plan));
}

std::int64_t hmi_table_bytes(const Matcher& matcher)
{
    // The level on its own, solved whole as a pair of level 0, once more copied by its match.
    const PairShape& shape = matcher.pair().shape;
    const LevelPlan plan = plan_levels(shape, Options{});
    PairTraits level = matcher.pair();
    level.shape = {plan.left_sizes.back(), plan.right_sizes.back(), plan.ranges.back()};
    Options options = matcher.options();
    options.mode = Mode::sgm;
    const Rect whole = rect_of(level.shape.left);
    const Matcher solver(level, options);
    const std::int64_t images = 2 * 2 * (whole.area() + level.shape.right.area());
    return solver.coarse_bytes() + result_bytes(whole, solver.plan()) + images;
}

} // namespace hsgm::matcher
