#include "matcher/cuda/level_memory.h"

#include "matcher/cuda/features.h"
#include "matcher/host/directions.h"

#include <algorithm>

namespace hsgm::matcher::cuda {

namespace {

using tiling::Rect;

template <typename T>
Plane<T> plane(Arena& arena, const Rect& rect)
{
    return {arena.take<T>(static_cast<std::size_t>(rect.area())), Area(rect)};
}

int stored(int count)
{
    return (count + 15) / 16 * 16;
}

template <typename Cell>
StripCase strip_case(const WindowKernel<Cell>& kernel, const Options& options,
                     const DeviceInfo& device, int count)
{
    StripCase c{};
    c.wide = kernel.is_wide();
    c.lanes = kernel.lanes;
    c.words = c.wide ? (count + 1) / 2 : kernel.lanes * kernel.words;
    c.window_px = options.window_px;
    c.halo_px = options.halo_px;
    c.paths = options.paths;
    c.cell_bytes = sizeof(Cell);
    c.shared_bytes = static_cast<std::size_t>(device.shared_bytes);
    c.warps = device.block_threads / 32;
    return c;
}

std::size_t level_index(int level)
{
    return static_cast<std::size_t>(level);
}

} // namespace

Directions directions_of(const Options& options)
{
    Directions result;
    for (const host::Direction& d : host::directions(options.paths)) {
        result.row[result.count] = d.row;
        result.col[result.count] = d.col;
        ++result.count;
    }
    return result;
}

template <typename Cell>
LevelStore<Cell> lay_out_store(Arena& arena, const Options& options, tiling::Size level,
                               const Rect& area, int window_px, int count)
{
    LevelStore<Cell> store;
    store.rows = level.rows;
    store.cols = level.cols;
    store.area = Area(area);
    store.window_px = window_px;
    store.stride = stored(count);
    store.grid = {options.window_px, options.halo_px};
    store.directions = directions_of(options);
    const auto pixels = static_cast<std::size_t>(area.area());
    const auto stride = static_cast<std::size_t>(store.stride);
    store.winner = arena.take<std::int16_t>(pixels);
    if (options.prior) {
        store.prior = arena.take<std::uint8_t>(pixels * stride);
    }
    store.lines = arena.take<Cell>(store.lay_out_lines() * stride);
    return store;
}

template <typename Cell>
std::vector<WindowLaunch<Cell>> window_launches(const Options& options,
                                                const DeviceInfo& device, int count)
{
    std::vector<WindowLaunch<Cell>> launches;
    int over = 0;
    const auto kernels =
        block_radius(options.cost) > 0 ? block_kernels(Cell{}) : window_kernels(Cell{});
    for (const auto& kernel : kernels) {
        const int up_to = kernel.most_count(count);
        // Windows have the level's range without pruning, and any range up to it with it.
        const bool wanted = up_to >= count || (options.prune && up_to > over);
        const StripLayout strips = strip_layout(strip_case(kernel, options, device, count));
        if (!wanted || strips.rows == 0) {
            continue;
        }
        launches.push_back({kernel, strips, over, up_to, device.multiprocessors});
        over = up_to;
        if (over >= count) {
            break;
        }
    }
    return launches;
}

template <typename Cell>
TileMemory<Cell> lay_out_tile(Arena& arena, const Matcher& matcher, const DeviceInfo& device,
                              const Rect& core)
{
    const LevelPlan& plan = matcher.plan();
    const Options& options = matcher.options();
    const auto support = matcher.support(core);
    TileMemory<Cell> memory;
    std::size_t scratch = 0;
    for (int level = 0; level < plan.windowed_levels(); ++level) {
        const auto k = level_index(level);
        const tiling::LevelSupport& s = support[k];
        const int count = plan.ranges[k].count();
        LevelMemory<Cell> m;
        m.left_pixels = plane<std::uint16_t>(arena, s.left_image);
        m.right_pixels = plane<std::uint16_t>(arena, s.right_image);
        m.tone = plane<std::uint8_t>(arena, s.left_image);
        m.low_texture = plane<std::uint8_t>(arena, s.aggregation);
        const Rect left = intersect(expand(s.aggregation, block_radius(options.cost)),
                                    rect_of(plan.left_sizes[k]));
        const Rect right =
            intersect(right_reach(left, plan.ranges[k]), rect_of(plan.right_sizes[k]));
        if (has_long_features(options.cost)) {
            m.long_left = plane<LongFeature>(arena, left);
            m.long_right = plane<LongFeature>(arena, right);
        } else {
            m.left = plane<Feature>(arena, left);
            m.right = plane<Feature>(arena, right);
        }
        m.windows_area = Area(s.windows);
        m.window_count = tiling::ceil_div(s.windows.rows, options.window_px) *
                         tiling::ceil_div(s.windows.cols, options.window_px);
        m.windows = arena.take<Window>(static_cast<std::size_t>(m.window_count));
        const auto launches = window_launches<Cell>(options, device, count);
        m.counters = arena.take<int>(launches.size());
        for (const auto& launch : launches) {
            const auto blocks =
                static_cast<std::size_t>(std::min(launch.blocks, m.window_count));
            scratch = std::max(scratch, blocks * launch.strips.scratch_bytes);
        }
        if (level > 0) {
            m.store = lay_out_store<Cell>(arena, options, plan.left_sizes[k], s.windows,
                                          options.window_px, count);
            m.store.windows = m.windows;
        }
        memory.levels.push_back(m);
    }
    const auto pixels = static_cast<std::size_t>(core.area());
    const Rect keys = keys_rect(matcher, core);
    memory.tile.core = Area(core);
    memory.tile.disparity_q8 = arena.take<std::int32_t>(pixels);
    memory.tile.confidence = arena.take<std::uint8_t>(pixels);
    memory.tile.reasons = arena.take<std::uint16_t>(pixels);
    memory.tile.keys_area = Area(keys);
    memory.tile.keys = arena.take<std::uint32_t>(static_cast<std::size_t>(keys.area()));
    memory.tile.asked_least = plan.ranges.front().min;
    memory.tile.asked_most = plan.ranges.front().max;
    memory.scratch = arena.take<unsigned char>(scratch);
    return memory;
}

std::int64_t upload_bytes(const Matcher& matcher, const Rect& core)
{
    std::int64_t pixels = 0;
    const auto support = matcher.support(core);
    for (int level = 0; level < matcher.plan().windowed_levels(); ++level) {
        const auto& s = support[level_index(level)];
        pixels += s.left_image.area() + s.right_image.area();
    }
    return 2 * pixels;
}

std::int64_t download_bytes(const Matcher& matcher, const Rect& core)
{
    std::int64_t windows = 0;
    const auto support = matcher.support(core);
    const int window_px = matcher.options().window_px;
    for (int level = 0; level < matcher.plan().windowed_levels(); ++level) {
        const Rect& all = support[level_index(level)].windows;
        windows += std::int64_t{tiling::ceil_div(all.rows, window_px)} *
                   tiling::ceil_div(all.cols, window_px);
    }
    return core.area() * (4 + 2 + 1) + keys_rect(matcher, core).area() * 4 +
           windows * static_cast<std::int64_t>(sizeof(Window));
}

Rect keys_rect(const Matcher& matcher, const Rect& core)
{
    const PairShape& shape = matcher.pair().shape;
    return intersect(right_reach(core, shape.asked), rect_of(shape.right));
}

#define HSGM_FOR_CELL(Cell)                                                                    \
    template LevelStore<Cell> lay_out_store(Arena&, const Options&, tiling::Size, const Rect&, \
                                            int, int);                                         \
    template std::vector<WindowLaunch<Cell>> window_launches(const Options&,                   \
                                                             const DeviceInfo&, int);          \
    template TileMemory<Cell> lay_out_tile(Arena&, const Matcher&, const DeviceInfo&,          \
                                           const Rect&);
HSGM_FOR_CELL(std::uint8_t)
HSGM_FOR_CELL(std::uint16_t)
#undef HSGM_FOR_CELL

} // namespace hsgm::matcher::cuda
