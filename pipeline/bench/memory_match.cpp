#include "pipeline/bench/memory_match.h"

#include "matcher/kernel.h"
#include "matcher/reduce.h"
#include "tiling/pyramid.h"
#include "tiling/tile_plan.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/concurrent_queue.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/partitioner.h>

#include <algorithm>
#include <chrono>
#include <mutex>

namespace hsgm::bench {

namespace {

using matcher::LevelImages;
using matcher::Matcher;
using tiling::Image;
using tiling::Patch;
using tiling::Rect;
using tiling::Size;

// Rows of a level that one task reduces, and pieces of the second pass as a run has them.
constexpr int kStripRows = 64;
constexpr int kPieceRows = 256;
constexpr int kPieceCols = 2048;

// Seconds since it was last asked.
class Lap {
public:
    double seconds()
    {
        const auto now = std::chrono::steady_clock::now();
        const std::chrono::duration<double> lap = now - last_;
        last_ = now;
        return lap.count();
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

template <typename T>
void paste(const Image<T>& part, const Rect& where, Image<T>& image)
{
    for (int row = 0; row < where.rows; ++row) {
        std::copy_n(part.row(row), where.cols, image.row(where.row + row) + where.col);
    }
}

Patch<std::uint16_t> whole_patch(const Image<std::uint16_t>& image)
{
    Patch<std::uint16_t> patch;
    patch.rect = rect_of(image.size());
    patch.pixels = image;
    return patch;
}

Patch<std::uint16_t> reduced(const Patch<std::uint16_t>& fine)
{
    const Size fine_size = fine.rect.size();
    Patch<std::uint16_t> coarse(rect_of(halve(fine_size)));
    tbb::parallel_for(0, tiling::ceil_div(coarse.rect.rows, kStripRows), [&](int strip) {
        const Rect part =
            intersect({strip * kStripRows, 0, kStripRows, coarse.rect.cols}, coarse.rect);
        matcher::reduce(fine, fine_size, part, coarse.view_of(part));
    });
    return coarse;
}

std::vector<LevelImages> pyramid(const BenchPair& pair, int levels)
{
    std::vector<LevelImages> images;
    images.push_back({whole_patch(pair.left), whole_patch(pair.right)});
    while (static_cast<int>(images.size()) < levels) {
        LevelImages next;
        tbb::parallel_invoke([&] { next.left = reduced(images.back().left); },
                             [&] { next.right = reduced(images.back().right); });
        images.push_back(std::move(next));
    }
    return images;
}

// First-pass results of the whole image, as the second pass reads them.
matcher::RefineInput empty_first_pass(const matcher::PairShape& shape)
{
    matcher::RefineInput first;
    first.disparity_q8 = Patch<std::int32_t>(rect_of(shape.left));
    first.confidence = Patch<std::uint8_t>(rect_of(shape.left));
    first.reasons = Patch<std::uint16_t>(rect_of(shape.left));
    first.right_keys = Patch<std::uint32_t>(rect_of(shape.right), matcher::kNoKey);
    return first;
}

// The one tile that covers the image.
matcher::RefineInput taken(matcher::TileMatch tile)
{
    matcher::RefineInput first;
    first.disparity_q8.rect = first.confidence.rect = first.reasons.rect = tile.core;
    first.disparity_q8.pixels = std::move(tile.disparity_q8);
    first.confidence.pixels = std::move(tile.confidence);
    first.reasons.pixels = std::move(tile.reasons);
    first.right_keys = std::move(tile.right_keys);
    return first;
}

void store(const matcher::TileMatch& tile, matcher::RefineInput& first)
{
    paste(tile.disparity_q8, tile.core, first.disparity_q8.pixels);
    paste(tile.confidence, tile.core, first.confidence.pixels);
    paste(tile.reasons, tile.core, first.reasons.pixels);
    const Rect seen = tile.right_keys.rect;
    for (int row = seen.row; seen.cols > 0 && row < seen.row_end(); ++row) {
        const std::uint32_t* keys = &tile.right_keys.at(row, seen.col);
        std::uint32_t* least = &first.right_keys.at(row, seen.col);
        for (int i = 0; i < seen.cols; ++i) {
            least[i] = std::min(least[i], keys[i]);
        }
    }
}

std::vector<Rect> cores_of(const tiling::TilePlan& plan)
{
    std::vector<Rect> cores;
    for (int i = 0; i < plan.count(); ++i) {
        cores.push_back(plan.core(i));
    }
    return cores;
}

// Streams of a device: one computes while the other copies.
int streams_for(const tiling::TilePlan& plan)
{
    return std::min(plan.count(), 2);
}

// Who matches tiles: the processor, or the streams of a device, each one tile at a time.
class TileWorker {
public:
    TileWorker(const Matcher& matcher, const matcher::CoarseSolution& coarse,
               const tiling::TilePlan& plan, const matcher::cuda::DeviceInfo* device)
        : matcher_(matcher), coarse_(coarse)
    {
        if (device == nullptr) {
            return;
        }
        const auto on_device = matcher::cuda::upload_coarse(matcher, coarse, *device);
        for (int i = 0; i < streams_for(plan); ++i) {
            streams_.push_back(matcher::cuda::make_device_matcher(matcher, on_device, *device,
                                                                  cores_of(plan)));
            free_.push(streams_.back().get());
        }
    }

    matcher::TileMatch match(const Rect& core, std::span<const LevelImages> images)
    {
        if (streams_.empty()) {
            return matcher_.match_tile(core, images, coarse_);
        }
        matcher::cuda::DeviceMatcher* stream = nullptr;
        free_.pop(stream);
        matcher::TileMatch match = stream->match_tile(core, images);
        free_.push(stream);
        return match;
    }

private:
    const Matcher& matcher_;
    const matcher::CoarseSolution& coarse_;
    std::vector<std::unique_ptr<matcher::cuda::DeviceMatcher>> streams_;
    tbb::concurrent_bounded_queue<matcher::cuda::DeviceMatcher*> free_;
};

matcher::RefineInput match_tiles(const Matcher& matcher, const std::vector<LevelImages>& images,
                                 const tiling::TilePlan& plan, TileWorker& worker,
                                 matcher::MatchStatistics& work)
{
    const auto& shape = matcher.pair().shape;
    const auto read =
        std::span(images).first(static_cast<std::size_t>(matcher.plan().windowed_levels()));
    if (plan.count() == 1) {
        matcher::TileMatch tile = worker.match(plan.core(0), read);
        work += tile.work;
        return taken(std::move(tile));
    }
    matcher::RefineInput first = empty_first_pass(shape);
    std::mutex storing;
    // As many tiles at once as there are threads, as in a run. Least keys do not ask for order.
    tbb::parallel_for(
        tbb::blocked_range<int>(0, plan.count()),
        [&](const tbb::blocked_range<int>& one) {
            const matcher::TileMatch tile = worker.match(plan.core(one.begin()), read);
            const std::lock_guard lock(storing);
            work += tile.work;
            store(tile, first);
        },
        tbb::simple_partitioner());
    return first;
}

matcher::Refined second_pass(const Matcher& matcher, const matcher::RefineInput& first)
{
    const auto& shape = matcher.pair().shape;
    const auto& options = matcher.options();
    matcher::Refined whole{Image<float>(shape.left), Image<std::uint8_t>(shape.left),
                           Image<std::uint16_t>(shape.left)};
    const int across = tiling::ceil_div(shape.left.cols, kPieceCols);
    const int down = tiling::ceil_div(shape.left.rows, kPieceRows);
    tbb::parallel_for(0, across * down, [&](int i) {
        const Rect core = intersect(
            {i / across * kPieceRows, i % across * kPieceCols, kPieceRows, kPieceCols},
            rect_of(shape.left));
        const matcher::Refined piece = matcher::refine(core, first, shape, options);
        paste(piece.disparity_px, core, whole.disparity_px);
        paste(piece.confidence, core, whole.confidence);
        paste(piece.reasons, core, whole.reasons);
    });
    return whole;
}

} // namespace

MemoryMatch match_in_memory(const BenchPair& pair, const matcher::Options& options,
                            int tile_size_px, const matcher::cuda::DeviceInfo* device)
{
    MemoryMatch match;
    Lap lap;
    matcher::PairTraits traits;
    traits.shape = pair.shape();
    traits.left_tone = pair.left_tone;
    traits.right_tone = pair.right_tone;
    const bool learns = options.cost == matcher::Cost::hmi;
    const int learnt_at = learns ? matcher::hmi_level(traits.shape) : 0;
    const int levels =
        std::max(matcher::plan_levels(traits.shape, options).levels(), learnt_at + 1);
    auto images = pyramid(pair, levels);
    match.seconds.pyramid = lap.seconds();
    if (learns) {
        const LevelImages& level = images[static_cast<std::size_t>(learnt_at)];
        traits.hmi =
            matcher::solve_hmi_table(traits, options, level.left.pixels, level.right.pixels);
    }
    match.seconds.table = lap.seconds();
    const Matcher matcher(traits, options);
    const auto top = static_cast<std::size_t>(matcher.plan().levels() - 1);
    const auto coarse = matcher.solve_coarse(images[top].left.pixels, images[top].right.pixels);
    match.work = work_of(*coarse);
    const tiling::TilePlan tiles(traits.shape.left, tile_size_px);
    TileWorker worker(matcher, *coarse, tiles, device);
    match.seconds.coarse = lap.seconds();
    auto first = match_tiles(matcher, images, tiles, worker, match.work);
    match.seconds.windows = lap.seconds();
    first.left = std::move(images[0].left);
    first.right = std::move(images[0].right);
    match.result = second_pass(matcher, first);
    match.seconds.second = lap.seconds();
    return match;
}

std::optional<std::string> why_not(const matcher::PairShape& shape,
                                   const matcher::Options& options, int tile_size_px,
                                   const matcher::cuda::DeviceInfo& device)
{
    matcher::PairTraits traits;
    traits.shape = shape;
    traits.hmi = std::make_shared<matcher::HmiTable>();
    const Matcher matcher(traits, options);
    std::string why = refusal(matcher, device);
    if (!why.empty()) {
        return why;
    }
    const tiling::TilePlan plan(shape.left, tile_size_px);
    const std::int64_t bytes =
        matcher::cuda::shared_bytes(matcher) +
        streams_for(plan) * worker_bytes(matcher, device, cores_of(plan));
    if (bytes > device.free_bytes) {
        return fmt::format("needs {} MiB of the device, which has {} MiB free", bytes >> 20,
                           device.free_bytes >> 20);
    }
    return std::nullopt;
}

std::int64_t memory_match_bytes(const matcher::PairShape& shape,
                                const matcher::Options& options, int tile_size_px, int threads)
{
    matcher::PairTraits traits;
    traits.shape = shape;
    traits.hmi = std::make_shared<matcher::HmiTable>();
    const Matcher matcher(traits, options);
    constexpr std::int64_t kPyramidBytes = 3; // 2 a pixel, and a third of that for the others
    constexpr std::int64_t kPassBytes = 2 * (4 + 1 + 2) + 4; // both passes, and the keys
    const std::int64_t images = kPyramidBytes * (shape.left.area() + shape.right.area());
    const std::int64_t passes = kPassBytes * std::max(shape.left.area(), shape.right.area());
    const Rect piece =
        intersect({shape.left.rows / 2, shape.left.cols / 2, kPieceRows, kPieceCols},
                  rect_of(shape.left));
    const std::int64_t second =
        threads * matcher::refine_bytes(piece, shape, matcher.options());
    return images + passes +
           std::max(matcher.coarse_bytes() + matcher.tile_bytes(tile_size_px, threads), second);
}

} // namespace hsgm::bench
