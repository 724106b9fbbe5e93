// Speed of the matching costs alone, on one thread, for every cost, range and instruction
// set: nanoseconds for each pixel x disparity of the windows of a level, as the matcher asks
// for them. Compare figures of one run only.

#include "matcher/host/level_features.h"
#include "matcher/host/matching_cost.h"
#include "matcher/kernel.h"

#include <benchmark/benchmark.h>
#include <hwy/targets.h>
#include <malloc.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <limits>
#include <random>
#include <string>

namespace {

using namespace hsgm;
using namespace hsgm::matcher;

constexpr int kSide = 768;
constexpr int kWindow = 64;
constexpr int kHalo = 8;

tiling::Patch<std::uint16_t> noise(std::uint64_t seed)
{
    std::mt19937_64 random(seed);
    tiling::Patch<std::uint16_t> image(tiling::rect_of(tiling::Size{kSide, kSide}));
    std::generate_n(image.pixels.data(), image.rect.area(),
                    [&random] { return static_cast<std::uint16_t>(random() % 256); });
    return image;
}

struct Level {
    LevelImages images{noise(1), noise(2)};
    PairTraits pair;
    Options options;
    LevelPlan plan;

    Level(Cost cost, int count)
    {
        pair.shape = {images.left.rect.size(), images.right.rect.size(), {0, count - 1}};
        auto table = std::make_shared<HmiTable>();
        for (std::size_t i = 0; i < table->cost.size(); ++i) {
            table->cost[i] = static_cast<std::uint8_t>(i * 7 % 49);
        }
        pair.hmi = table;
        options.cost = cost;
        plan = plan_levels(pair.shape, options);
    }
    host::LevelFeatures features() const
    {
        return host::level_features(images, plan, 0, images.left.rect, pair, options);
    }
};

// The costs of every window, each row as the matcher fills it.
void all_windows(const Level& level, const host::LevelFeatures& features, int count,
                 std::vector<std::uint8_t>& costs, host::CostWorkspace& workspace)
{
    for (int row = 0; row < kSide; row += kWindow) {
        for (int col = 0; col < kSide; col += kWindow) {
            host::CostVolume volume;
            volume.rect = intersect(expand(tiling::Rect{row, col, kWindow, kWindow}, kHalo),
                                    level.images.left.rect);
            volume.range = {0, count - 1};
            volume.stride = padded_count(count);
            const auto pitch = static_cast<std::size_t>(volume.rect.cols * volume.stride);
            costs.resize(std::max(costs.size(), pitch * std::size_t(volume.rect.rows)));
            volume.data = costs.data();
            for (int r = volume.rect.row; r < volume.rect.row_end(); ++r) {
                host::matching_cost_row(features, level.pair, level.options.cost, volume, r,
                                        costs.data() + pitch * std::size_t(r - volume.rect.row),
                                        workspace);
            }
            benchmark::DoNotOptimize(costs.data());
        }
    }
}

// The instruction set `target`, and where a file knows no use for it the next best one.
void use(std::int64_t target)
{
    hwy::SetSupportedTargetsForTest(hwy::SupportedTargets() & -target);
}

void set_time(benchmark::State& state, double things)
{
    state.counters["each"] =
        benchmark::Counter(things * static_cast<double>(state.iterations()),
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void costs_of(benchmark::State& state, Cost cost, int count, std::int64_t target)
{
    use(target);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Level level(cost, count);
    const host::LevelFeatures features = level.features();
    std::vector<std::uint8_t> costs;
    host::CostWorkspace workspace;
    for (auto _ : state) {
        all_windows(level, features, count, costs, workspace);
    }
    const double reach = kSide + 2.0 * kHalo * (double{kSide} / kWindow - 1);
    set_time(state, reach * reach * count);
    hwy::SetSupportedTargetsForTest(0);
}

void features_of(benchmark::State& state, Cost cost, std::int64_t target)
{
    use(target);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Level level(cost, kWindow);
    for (auto _ : state) {
        benchmark::DoNotOptimize(level.features());
    }
    set_time(state, double{kSide} * kSide);
    hwy::SetSupportedTargetsForTest(0);
}

void add(Cost cost, std::int64_t target)
{
    const std::string what = std::string(name(cost)) + "/" + hwy::TargetName(target);
    for (const int count : {32, 128}) {
        benchmark::RegisterBenchmark(("px*d/" + what + "/" + std::to_string(count)).c_str(),
                                     costs_of, cost, count, target);
    }
    benchmark::RegisterBenchmark(("features a px/" + what).c_str(), features_of, cost, target);
}

} // namespace

int main(int argc, char** argv)
{
    // As the program does: freed memory is kept, so that page faults are not what is measured.
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
    for (const std::int64_t target : {HWY_AVX3_DL, HWY_AVX3, HWY_AVX2, HWY_SSE4}) {
        if ((hwy::SupportedTargets() & target) == 0) {
            continue;
        }
        for (const Cost cost : all_costs()) {
            add(cost, target);
        }
    }
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
