#include "matcher/cuda/tile_matcher.h"

#include "matcher/cuda/features.h"
#include "matcher/cuda/window_ranges.h"
#include "matcher/host/directions.h"
#include "matcher/kernel.h"

#include <algorithm>
#include <cstring>

namespace hsgm::matcher::cuda {

namespace {

using tiling::Rect;

constexpr const char* kWhat = "starting work on the device";

// The most that any of the cores takes.
template <typename Bytes>
std::int64_t most(std::span<const Rect> cores, Bytes bytes)
{
    std::int64_t result = 1;
    for (const Rect& core : cores) {
        result = std::max<std::int64_t>(result, bytes(core));
    }
    return result;
}

template <typename Cell>
std::int64_t tile_bytes(const Matcher& matcher, const DeviceInfo& device, const Rect& core)
{
    Arena arena;
    lay_out_tile<Cell>(arena, matcher, device, core);
    return static_cast<std::int64_t>(arena.used());
}

template <typename Cell>
std::size_t windows_of(const TileMemory<Cell>& memory)
{
    std::size_t count = 0;
    for (const LevelMemory<Cell>& m : memory.levels) {
        count += static_cast<std::size_t>(m.window_count);
    }
    return count;
}

// The pixels that paths of direction `r` run over: see path_region in window_frame.cuh.
Rect run_over(const Rect& core, host::Direction r, int halo_px, const Rect& image)
{
    return intersect(tiling::rect_between(core.row - (r.row > 0 ? halo_px : 0),
                                          core.col - (r.col > 0 ? halo_px : 0),
                                          core.row_end() + (r.row < 0 ? halo_px : 0),
                                          core.col_end() + (r.col < 0 ? halo_px : 0)),
                     image);
}

template <typename T>
Plane<const T> read_only(const Plane<T>& plane)
{
    return {plane.data, plane.area};
}

} // namespace

template <typename Cell>
TileMatcher<Cell>::TileMatcher(const Matcher& matcher,
                               std::shared_ptr<const CoarseOnDevice<Cell>> coarse,
                               const DeviceInfo& device, std::span<const Rect> cores)
    : matcher_(matcher), coarse_(std::move(coarse)), device_(device),
      buffer_(most(cores, [&](const Rect& c) { return tile_bytes<Cell>(matcher, device, c); })),
      up_(most(cores, [&](const Rect& c) { return upload_bytes(matcher, c); })),
      down_(most(cores, [&](const Rect& c) { return download_bytes(matcher, c); }))
{
}

template <typename Cell>
TileMatch TileMatcher<Cell>::match_tile(const Rect& core, std::span<const LevelImages> images)
{
    check(cudaSetDevice(device_.number), "choosing the device");
    Arena arena(buffer_.data(), buffer_.size());
    const auto memory = lay_out_tile<Cell>(arena, matcher_, device_, core);
    upload(memory, images);
    for (int level = matcher_.plan().windowed_levels() - 1; level >= 0; --level) {
        solve_level(memory, level);
    }
    return download(memory, core);
}

// Through pinned memory, from which the device copies while the processor does other things.
template <typename Cell>
void TileMatcher<Cell>::upload(const TileMemory<Cell>& memory,
                               std::span<const LevelImages> images)
{
    unsigned char* at = up_.data();
    const auto copy = [&](const tiling::Patch<std::uint16_t>& from,
                          const Plane<std::uint16_t>& to) {
        const Rect rect{to.area.row, to.area.col, to.area.rows, to.area.cols};
        const std::size_t row_bytes = std::size_t(rect.cols) * 2;
        const std::size_t bytes = row_bytes * std::size_t(rect.rows);
        if (bytes == 0) {
            return;
        }
        for (int r = 0; r < rect.rows; ++r) {
            std::memcpy(at + std::size_t(r) * row_bytes, &from.at(rect.row + r, rect.col),
                        row_bytes);
        }
        check(cudaMemcpyAsync(to.data, at, bytes, cudaMemcpyHostToDevice, stream_.get()),
              "copying images to the device");
        at += bytes;
    };
    for (std::size_t k = 0; k < memory.levels.size(); ++k) {
        copy(images[k].left, memory.levels[k].left_pixels);
        copy(images[k].right, memory.levels[k].right_pixels);
    }
}

template <typename Cell>
SolveJob<Cell> TileMatcher<Cell>::job_of(const TileMemory<Cell>& memory, int level) const
{
    const auto k = static_cast<std::size_t>(level);
    const Options& options = matcher_.options();
    const LevelPlan& plan = matcher_.plan();
    const LevelMemory<Cell>& m = memory.levels[k];
    const SharedMemory<Cell>& shared = coarse_->memory();
    SolveJob<Cell> job;
    job.image = Area(rect_of(plan.left_sizes[k]));
    job.right_cols = plan.right_sizes[k].cols;
    job.left_pixels = read_only(m.left_pixels);
    job.right_pixels = read_only(m.right_pixels);
    job.tone = read_only(m.tone);
    job.low_texture = read_only(m.low_texture);
    job.left = read_only(m.left);
    job.right = read_only(m.right);
    job.long_left = read_only(m.long_left);
    job.long_right = read_only(m.long_right);
    job.cost = cost_rule(options.cost, shared.hmi);
    job.directions = directions_of(options);
    job.halo_px = options.halo_px;
    job.p1 = options.p1;
    job.p2 = shared.p2;
    job.unsearched = options.p2 + kUnsearchedMargin;
    job.windows = m.windows;
    job.window_count = m.window_count;
    job.has_coarser = shared.has_coarse;
    if (job.has_coarser) {
        const bool top = k + 1 == memory.levels.size();
        job.coarser = top ? shared.store : memory.levels[k + 1].store;
        job.coarser_tone = read_only(top ? shared.tone : memory.levels[k + 1].tone);
        job.add_prior = options.prior;
        job.equation_3 = options.mode == Mode::hsgm_paper;
    }
    job.finest = level == 0;
    job.store = m.store;
    job.tile = memory.tile;
    job.scratch = memory.scratch;
    return job;
}

template <typename Cell>
void TileMatcher<Cell>::make_features(const SolveJob<Cell>& job, const LevelMemory<Cell>& m,
                                      const Area& right_image)
{
    const PairTraits& pair = matcher_.pair();
    const Cost cost = matcher_.options().cost;
    const cudaStream_t stream = stream_.get();
    check(compute_tones(job.left_pixels, pair.left_tone, m.tone, stream), kWhat);
    check(compute_low_texture(job.left_pixels, job.tone, m.low_texture, stream), kWhat);
    if (has_long_features(cost)) {
        check(compute_long_features(job.left_pixels, job.image, cost, pair.left_tone,
                                    m.long_left, stream),
              kWhat);
        check(compute_long_features(job.right_pixels, right_image, cost, pair.right_tone,
                                    m.long_right, stream),
              kWhat);
        return;
    }
    check(compute_features(job.left_pixels, job.image, cost, pair.left_tone, m.left, stream),
          kWhat);
    check(
        compute_features(job.right_pixels, right_image, cost, pair.right_tone, m.right, stream),
        kWhat);
}

template <typename Cell>
void TileMatcher<Cell>::solve_level(const TileMemory<Cell>& memory, int level)
{
    const auto k = static_cast<std::size_t>(level);
    const Options& options = matcher_.options();
    const LevelMemory<Cell>& m = memory.levels[k];
    const tiling::DisparityRange range = matcher_.plan().ranges[k];
    const cudaStream_t stream = stream_.get();
    SolveJob<Cell> job = job_of(memory, level);
    make_features(job, m, Area(rect_of(matcher_.plan().right_sizes[k])));
    RangeJob ranges;
    ranges.area = m.windows_area;
    ranges.window_px = options.window_px;
    ranges.least = range.min;
    ranges.count = range.count();
    ranges.windows = m.windows;
    ranges.prune = options.prune && job.has_coarser;
    if (ranges.prune) {
        ranges.coarse_rows = job.coarser.rows;
        ranges.coarse_cols = job.coarser.cols;
        ranges.coarse_winner = {job.coarser.winner, job.coarser.area};
    }
    check(find_window_ranges(ranges, stream), kWhat);
    if (job.finest) {
        check(cudaMemsetAsync(memory.tile.keys, 0xFF,
                              memory.tile.keys_area.pixels() * sizeof(std::uint32_t), stream),
              kWhat);
    }
    const auto launches = window_launches<Cell>(options, device_, range.count());
    check(cudaMemsetAsync(m.counters, 0, launches.size() * sizeof(int), stream), kWhat);
    for (std::size_t i = 0; i < launches.size(); ++i) {
        const WindowLaunch<Cell>& l = launches[i];
        job.next_window = m.counters + i;
        job.over_count = l.over_count;
        job.up_to_count = l.up_to_count;
        job.strips = l.strips;
        check(launch(l.kernel.kernel, std::min(l.blocks, m.window_count), device_.block_threads,
                     l.strips.bytes, stream, job),
              kWhat);
    }
}

template <typename Cell>
TileMatch TileMatcher<Cell>::download(const TileMemory<Cell>& memory, const Rect& core)
{
    TileMatch match;
    match.core = core;
    match.disparity_q8 = tiling::Image<std::int32_t>(core.size());
    match.confidence = tiling::Image<std::uint8_t>(core.size());
    match.reasons = tiling::Image<std::uint16_t>(core.size());
    match.right_keys = tiling::Patch<std::uint32_t>(keys_rect(matcher_, core));
    struct Part {
        void* to;
        const void* from;
        std::size_t bytes;
    };
    const auto pixels = static_cast<std::size_t>(core.area());
    std::vector<Window> windows(windows_of(memory));
    std::vector<Part> parts{
        {match.disparity_q8.data(), memory.tile.disparity_q8, pixels * 4},
        {match.confidence.data(), memory.tile.confidence, pixels},
        {match.reasons.data(), memory.tile.reasons, pixels * 2},
        {match.right_keys.pixels.data(), memory.tile.keys, memory.tile.keys_area.pixels() * 4},
    };
    Window* to = windows.data();
    for (const LevelMemory<Cell>& m : memory.levels) {
        parts.push_back({to, m.windows, std::size_t(m.window_count) * sizeof(Window)});
        to += m.window_count;
    }
    unsigned char* at = down_.data();
    for (const Part& part : parts) {
        if (part.bytes > 0) {
            check(cudaMemcpyAsync(at, part.from, part.bytes, cudaMemcpyDeviceToHost,
                                  stream_.get()),
                  "copying results from the device");
        }
        at += part.bytes;
    }
    stream_.wait();
    at = down_.data();
    for (const Part& part : parts) {
        if (part.bytes > 0) {
            std::memcpy(part.to, at, part.bytes);
        }
        at += part.bytes;
    }
    match.work = work_of(memory, windows.data());
    return match;
}

// As the host counts it; the ranges of the windows are known only now.
template <typename Cell>
MatchStatistics TileMatcher<Cell>::work_of(const TileMemory<Cell>& memory,
                                           const Window* windows) const
{
    const Options& options = matcher_.options();
    MatchStatistics work;
    for (std::size_t k = 0; k < memory.levels.size(); ++k) {
        const Rect image = rect_of(matcher_.plan().left_sizes[k]);
        for (int i = 0; i < memory.levels[k].window_count; ++i, ++windows) {
            const Rect core{windows->core.row, windows->core.col, windows->core.rows,
                            windows->core.cols};
            ++work.windows;
            work.cells +=
                intersect(expand(core, options.halo_px), image).area() * windows->count;
            for (const host::Direction& r : host::directions(options.paths)) {
                work.path_steps +=
                    run_over(core, r, options.halo_px, image).area() * windows->count;
            }
        }
    }
    return work;
}

template class TileMatcher<std::uint8_t>;
template class TileMatcher<std::uint16_t>;

} // namespace hsgm::matcher::cuda
