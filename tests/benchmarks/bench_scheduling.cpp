// What the flow graph and the worker pool cost beside a plain loop over the same tiles, and
// what one heap for all threads (pipeline/freed_memory.cpp) costs beside one for each:
//
//     ninja -C build hsgm_bench_scheduling && build/hsgm_bench_scheduling [SIDE [ROUNDS]]
//
// A pair in memory (scene town, 128 disparities, default options). Both do the same for a tile:
// copy the images of its support, match it, store the result. They take turns; the figures are
// medians over rounds of the ratio of two runs that follow each other, so that what slows the
// machine for a while slows both.
#include "matcher/reduce.h"
#include "pipeline/bench/bench_pair.h"
#include "pipeline/bench/measure.h"
#include "pipeline/cpu_worker.h"
#include "pipeline/tile_graph.h"
#include "tiling/tile_plan.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace hsgm;
using matcher::LevelImages;
using tiling::Patch;

constexpr int kDisparities = 128;

template <typename T>
Patch<T> crop(const Patch<T>& whole, const tiling::Rect& rect)
{
    Patch<T> part(rect);
    for (int row = 0; row < rect.rows; ++row) {
        std::copy_n(whole.pixels.row(rect.row + row) + rect.col, rect.cols,
                    part.pixels.row(row));
    }
    return part;
}

Patch<std::uint16_t> whole(tiling::Image<std::uint16_t> pixels)
{
    Patch<std::uint16_t> patch;
    patch.rect = rect_of(pixels.size());
    patch.pixels = std::move(pixels);
    return patch;
}

std::vector<LevelImages> pyramid(const bench::BenchPair& pair, int levels)
{
    std::vector<LevelImages> images{{whole(pair.left), whole(pair.right)}};
    const auto reduced = [](const Patch<std::uint16_t>& fine) {
        tiling::Image<std::uint16_t> coarse(halve(fine.rect.size()));
        matcher::reduce(fine, fine.rect.size(), rect_of(coarse.size()), coarse);
        return whole(std::move(coarse));
    };
    while (static_cast<int>(images.size()) < levels) {
        images.push_back({reduced(images.back().left), reduced(images.back().right)});
    }
    return images;
}

/// One pair and the tiles of one size, matched in two ways.
class Setting {
public:
    Setting(int side, int tile_px, int threads)
        : pair_(bench::render_pair("town", side, kDisparities)), threads_(threads),
          plan_(pair_.left.size(), tile_px)
    {
        matcher::PairTraits traits;
        traits.shape = pair_.shape();
        traits.left_tone = pair_.left_tone;
        traits.right_tone = pair_.right_tone;
        matcher_ = std::make_shared<matcher::Matcher>(traits, matcher::Options{});
        images_ = pyramid(pair_, matcher_->plan().levels());
        coarse_ =
            matcher_->solve_coarse(images_.back().left.pixels, images_.back().right.pixels);
        stored_ = tiling::Image<std::int32_t>(pair_.left.size());
    }

    int tiles() const { return plan_.count(); }

    void plain_loop()
    {
        bench::on_threads(threads_, [&] {
            for (int tile = 0; tile < plan_.count(); ++tile) {
                const pipeline::TileTask task = read(tile);
                store(matcher_->match_tile(task.core, task.images, *coarse_));
            }
        });
    }

    // As a run does it: two workers where there are two threads, one more tile in flight.
    void flow_graph()
    {
        bench::on_threads(threads_, [&] {
            const auto arena = std::make_shared<tbb::task_arena>(threads_);
            std::vector<std::shared_ptr<pipeline::MatchWorker>> workers;
            for (int i = 0; i < std::min(threads_, 2); ++i) {
                workers.push_back(
                    std::make_shared<pipeline::CpuWorker>(i, matcher_, coarse_, arena));
            }
            pipeline::WorkerPool pool(workers, {});
            std::vector<int> sequence(static_cast<std::size_t>(plan_.count()));
            std::iota(sequence.begin(), sequence.end(), 0);
            pipeline::TileSteps steps;
            steps.read = [&](int tile) { return read(tile); };
            steps.write = [&](int, const matcher::TileMatch& match) { store(match); };
            run_tiles(sequence, steps, pool, static_cast<int>(workers.size()) + 1);
        });
    }

private:
    pipeline::TileTask read(int tile) const
    {
        pipeline::TileTask task;
        task.index = tile;
        task.core = plan_.core(tile);
        const auto support = matcher_->support(task.core);
        for (int level = 0; level < matcher_->plan().windowed_levels(); ++level) {
            const auto k = static_cast<std::size_t>(level);
            task.images.push_back({crop(images_[k].left, support[k].left_image),
                                   crop(images_[k].right, support[k].right_image)});
        }
        return task;
    }
    void store(const matcher::TileMatch& match)
    {
        for (int row = 0; row < match.core.rows; ++row) {
            std::copy_n(match.disparity_q8.row(row), match.core.cols,
                        stored_.row(match.core.row + row) + match.core.col);
        }
    }

    bench::BenchPair pair_;
    int threads_;
    tiling::TilePlan plan_;
    std::shared_ptr<const matcher::Matcher> matcher_;
    std::vector<LevelImages> images_;
    std::shared_ptr<const matcher::CoarseSolution> coarse_;
    tiling::Image<std::int32_t> stored_;
};

struct Taken {
    double wall_s = 0;
    double cpu_s = 0;
};

Taken timed(const std::function<void()>& work)
{
    const double cpu_s = bench::cpu_clock_s();
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    return {wall.count(), bench::cpu_clock_s() - cpu_s};
}

/// Medians of `second` over `first`, in per cent above it.
void compare(const std::string& label, int rounds, const std::function<void()>& first,
             const std::function<void()>& second)
{
    timed(first);
    timed(second);
    std::vector<double> wall;
    std::vector<double> cpu;
    std::vector<double> base_s;
    for (int i = 0; i < rounds; ++i) {
        const Taken a = timed(first);
        const Taken b = timed(second);
        base_s.push_back(a.wall_s);
        wall.push_back(100 * (b.wall_s / a.wall_s - 1));
        cpu.push_back(100 * (b.cpu_s / a.cpu_s - 1));
    }
    fmt::print("| {} | {:.3f} | {:+.2f} | {:+.2f} |\n", label, bench::median(base_s),
               bench::median(wall), bench::median(cpu));
    std::fflush(stdout);
}

void set_heaps(int count)
{
    mallopt(M_MMAP_THRESHOLD, 32 << 20); // as pipeline/freed_memory.cpp has it
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
    mallopt(M_ARENA_MAX, count);
}

// Threads keep the heap that they have had, so each number of heaps gets a process of its own.
void run_with_heaps(int side, int threads, int heaps)
{
    set_heaps(heaps);
    Setting setting(side, 256, threads);
    setting.flow_graph();
    Taken least{1e9, 1e9};
    for (int i = 0; i < 3; ++i) {
        const Taken taken = timed([&] { setting.flow_graph(); });
        least = {std::min(least.wall_s, taken.wall_s), std::min(least.cpu_s, taken.cpu_s)};
    }
    fmt::print("{} {}\n", least.wall_s, least.cpu_s);
}

Taken child_with_heaps(const std::string& program, int side, int threads, int heaps)
{
    const std::string command =
        fmt::format("'{}' heaps {} {} {}", program, side, threads, heaps);
    FILE* const answer = ::popen(command.c_str(), "r");
    Taken taken;
    if (answer == nullptr || std::fscanf(answer, "%lf %lf", &taken.wall_s, &taken.cpu_s) != 2) {
        throw std::runtime_error("no answer from " + command);
    }
    ::pclose(answer);
    return taken;
}

void compare_heaps(const std::string& program, int side, int threads, int rounds)
{
    std::vector<double> wall;
    std::vector<double> cpu;
    std::vector<double> base_s;
    for (int i = 0; i < rounds; ++i) {
        const Taken eight = child_with_heaps(program, side, threads, 8);
        const Taken one = child_with_heaps(program, side, threads, 1);
        base_s.push_back(eight.wall_s);
        wall.push_back(100 * (one.wall_s / eight.wall_s - 1));
        cpu.push_back(100 * (one.cpu_s / eight.cpu_s - 1));
    }
    fmt::print("| tiles of 256 px, {} threads | {:.3f} | {:+.2f} | {:+.2f} |\n", threads,
               bench::median(base_s), bench::median(wall), bench::median(cpu));
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv)
{
    const std::vector<std::string> words(argv, argv + argc);
    if (words.size() == 5 && words[1] == "heaps") {
        run_with_heaps(std::stoi(words[2]), std::stoi(words[3]), std::stoi(words[4]));
        return 0;
    }
    const int side = argc > 1 ? std::stoi(words[1]) : 2048;
    const int rounds = argc > 2 ? std::stoi(words[2]) : 7;
    set_heaps(1);
    fmt::print("| flow graph over plain loop, {} x {} px | loop, s | wall clock, % | CPU, % |\n"
               "|---|---|---|---|\n",
               side, side);
    for (const int threads : {1, 2}) {
        for (const int tile : {64, 256, 1024}) {
            Setting setting(side, tile, threads);
            compare(
                fmt::format("{} tiles of {} px, {} threads", setting.tiles(), tile, threads),
                rounds, [&] { setting.plain_loop(); }, [&] { setting.flow_graph(); });
        }
    }
    fmt::print("\n| one heap over eight | eight, s | wall clock, % | CPU, % |\n"
               "|---|---|---|---|\n");
    for (const int threads : {1, 2, 4}) {
        compare_heaps(words[0], side, threads, rounds);
    }
    return 0;
}
