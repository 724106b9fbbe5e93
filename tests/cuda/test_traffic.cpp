#include "tests/catch.h"

#include "matcher/cuda/features.h"
#include "matcher/cuda/level_memory.h"
#include "matcher/profile.h"

#include <cstdio>

// The device memory that a match moves, predicted from the layouts that the kernels use
// (docs/cuda.md): nothing here was measured on a device.
namespace {

using namespace hsgm;
using namespace hsgm::matcher;
using namespace hsgm::matcher::cuda;

constexpr int kSide = 4096;
constexpr int kCount = 128;

// Bytes a pixel and disparity of level 0. Neighbouring windows are solved at the same time, and
// what they read in common is counted once; the two passes over a window are far apart, and
// are counted both. Keys and what paths park between strips stay in the second level cache.
struct Traffic {
    double checkpoints = 0; ///< of paths that go up: written once, read once
    double features = 0;    ///< made once, read in both passes
    double coarse = 0;      ///< winners, prior and start lines: written once, read by passes
    double rest = 0;        ///< images, results, right-view keys

    double sum() const { return checkpoints + features + coarse + rest; }
};

DeviceInfo device_with(std::int64_t kibibytes)
{
    DeviceInfo device;
    device.shared_bytes = kibibytes * 1024;
    device.multiprocessors = 132;
    return device;
}

int ceil_of(int a, int b)
{
    return (a + b - 1) / b;
}

// One level by windows, without pruning; bytes.
void add_level(Traffic& t, const Options& o, const DeviceInfo& device, int level)
{
    const int side = kSide >> level;
    const int count = kCount >> level;
    const double windows = double(side) / o.window_px * side / o.window_px;
    Options unpruned = o;
    unpruned.prune = false;
    const auto launch = window_launches<std::uint8_t>(unpruned, device, count).back();
    const StripLayout& s = launch.strips;
    const double strips = ceil_of(o.window_px, s.rows);
    // Directions that go up: one straight, and with 8 paths two slanting ones.
    const double slanting = o.paths == 8 ? 2 * (o.window_px + o.halo_px) : 0;
    const double lines = o.window_px + slanting;
    t.checkpoints += windows * lines * 2 * s.words * 2 * strips;
    const double pixels = double(side) * side;
    const double feature = has_long_features(o.cost) ? sizeof(LongFeature) : sizeof(Feature);
    const double made = 2 * 2 + 2 * feature + 1 + 1;
    const double read = 2 * feature + 1 + 1;
    const double both_passes = 2 * double(o.window_px + o.halo_px) / o.window_px;
    t.features += pixels * (made + read * both_passes);
    // What the coarser level left for this one; the coarsest was solved by the processor.
    {
        Arena arena;
        const int half = side / 2;
        const auto store = lay_out_store<std::uint8_t>(
            arena, o, {half, half}, {0, 0, half, half}, o.window_px, count / 2);
        const double prior = double(half) * half * store.stride;
        const double others = static_cast<double>(arena.used()) - prior;
        t.coarse += prior * (1 + both_passes) + others * (1 + 2);
    }
    t.rest += pixels * 2 * 2; // images
}

Traffic traffic(const DeviceInfo& device, const Options& options = {})
{
    Traffic t;
    add_level(t, options, device, 0);
    add_level(t, options, device, 1);
    const double pixels = double(kSide) * kSide;
    t.rest += pixels * (4 + 1 + 2) + pixels * 4 * 2; // results, and keys filled and written
    const double cells = pixels * kCount;
    return {t.checkpoints / cells, t.features / cells, t.coarse / cells, t.rest / cells};
}

} // namespace

TEST_CASE("a match moves at most 2.5 bytes of device memory a pixel and disparity")
{
    const Traffic t = traffic(device_with(227));
    std::printf("H100: %.2f bytes: checkpoints %.2f, features %.2f, coarse %.2f, rest %.2f\n",
                t.sum(), t.checkpoints, t.features, t.coarse, t.rest);
    CHECK(t.sum() <= 2.5);
    CHECK(t.sum() > 1);
    for (const int kibibytes : {163, 99, 64}) {
        const auto device = device_with(kibibytes);
        Options unpruned;
        unpruned.prune = false;
        const auto launch = window_launches<std::uint8_t>(unpruned, device, kCount).back();
        std::printf("%d KiB: strips of %d rows, %.2f bytes\n", kibibytes, launch.strips.rows,
                    traffic(device).sum());
        CHECK(launch.strips.rows > 0);
    }
}

TEST_CASE("profile close moves at most 2.5 bytes, too")
{
    const Traffic t = traffic(device_with(227), options_of(Profile::close));
    std::printf("H100: %.2f bytes: checkpoints %.2f, features %.2f, coarse %.2f, rest %.2f\n",
                t.sum(), t.checkpoints, t.features, t.coarse, t.rest);
    CHECK(t.sum() <= 2.5);
    CHECK(t.sum() > 1);
}

TEST_CASE("shared memory stays within what each processor has")
{
    for (const int kibibytes : {227, 163, 99, 64}) {
        for (const int paths : {4, 5, 8, 16}) {
            for (const int count : {16, 64, 128, 256, 512, 513, 5000}) {
                Options options;
                options.paths = paths;
                for (const auto& launch :
                     window_launches<std::uint8_t>(options, device_with(kibibytes), count)) {
                    CHECK(launch.strips.bytes <= std::size_t(kibibytes) * 1024);
                    CHECK(launch.strips.rows > 0);
                    CHECK((paths != 16 || launch.strips.rows % 2 == 0));
                }
                CHECK(window_launches<std::uint8_t>(options, device_with(kibibytes), count)
                          .back()
                          .up_to_count >= count);
            }
        }
    }
}
