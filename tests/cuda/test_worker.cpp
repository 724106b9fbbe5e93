#include "tests/catch.h"

#include "tests/cuda/comparison.h"
#include "tests/reference/themes.h"

#include "pipeline/cuda_worker.h"

#include <algorithm>

using namespace hsgm;
using namespace hsgm::pipeline;
using Catch::Matchers::Contains;

namespace {

// A pair of several tiles, matched by windows.
reference::Case small_case()
{
    reference::Theme theme;
    theme.most_side_px = 60;
    theme.least_count = 10;
    theme.most_count = 30;
    theme.vary = [](reference::Random&, reference::Options& o) {
        o = {};
        o.levels = 2;
        o.window_px = 16;
    };
    reference::Case c = reference::random_case(7, theme);
    c.tiles = {{0, 0, c.pair.left.rows(), c.pair.left.cols()}};
    return c;
}

Budget budget_of(int tile_size_px)
{
    Budget budget;
    budget.tile_size_px = tile_size_px;
    budget.tiles = 4;
    budget.workers = 1;
    budget.tiles_in_flight = 2;
    budget.memory_bytes = std::int64_t{1} << 40;
    return budget;
}

// What a run does with its tiles, without its files.
struct Bench {
    reference::Case c = small_case();
    cuda_test::Pair pair{c};
    Budget budget = budget_of(32);
    std::vector<std::string> troubles;

    Bench() { cuda_test::device_of({}); }
    ~Bench() { stand_in::reset(); }

    std::vector<std::shared_ptr<MatchWorker>> workers(const char* device)
    {
        Budget shared = budget; // which the plan takes for the devices' tiles, too
        const DevicePlan plan = plan_devices(device_choice(device), pair.matcher(), shared);
        return make_workers(plan, shared, basis(),
                            [this](const std::string& why) { troubles.push_back(why); });
    }
    /// Borrowed: workers go before the pair does.
    MatchBasis basis() const
    {
        const std::shared_ptr<void> nobody;
        return {{nobody, &pair.matcher()},
                {nobody, &pair.coarse()},
                std::make_shared<tbb::task_arena>(2)};
    }
    /// How many tiles differ from the host's.
    int differing(MatchWorker& worker)
    {
        int count = 0;
        const auto cores = tile_cores(pair.matcher(), budget);
        for (std::size_t i = 0; i < cores.size(); ++i) {
            TileTask task;
            task.index = static_cast<int>(i);
            task.core = cores[i];
            task.images = pair.images(cores[i]);
            const auto host = pair.matcher().match_tile(task.core, task.images, pair.coarse());
            count += cuda_test::difference(host, worker.match(task)).empty() ? 0 : 1;
        }
        return count;
    }
};

} // namespace

TEST_CASE("device choices are read, and others refused")
{
    CHECK(device_choice("auto").kind == DeviceChoice::Kind::automatic);
    CHECK(device_choice("cpu").kind == DeviceChoice::Kind::cpu);
    CHECK(device_choice("cuda").number == -1);
    CHECK(device_choice("cuda:3").number == 3);
    for (const char* wrong : {"", "gpu", "cuda:", "cuda:x", "cuda:-1", "cuda:1 "}) {
        CHECK_THROWS_WITH(device_choice(wrong), "it must be auto, cpu, cuda or cuda:N");
    }
}

TEST_CASE("a device's workers share the tiles with the processor's, and give the same bits")
{
    Bench bench;
    const auto workers = bench.workers("auto");
    REQUIRE(workers.size() == 3);
    CHECK(workers[0]->name() == "cuda:0 stream 0");
    CHECK(workers[1]->name() == "cuda:0 stream 1");
    CHECK(workers[2]->name() == "cpu 0");
    const auto before = stand_in::launches();
    for (const auto& worker : workers) {
        CHECK(bench.differing(*worker) == 0);
    }
    CHECK(stand_in::launches() > before);
    CHECK(bench.troubles.empty());
    CHECK(bench.workers("cpu").size() == 1);
}

TEST_CASE("a device takes exactly the memory that was planned for it")
{
    Bench bench;
    const auto before = static_cast<std::int64_t>(stand_in::allocated_bytes());
    const DevicePlan plan =
        plan_devices(device_choice("cuda"), bench.pair.matcher(), bench.budget);
    REQUIRE(plan.cuda.size() == 1);
    CHECK(plan.cuda[0].streams == 2);
    const auto workers =
        make_workers(plan, bench.budget, bench.basis(), [](const std::string&) {});
    CHECK(static_cast<std::int64_t>(stand_in::allocated_bytes()) - before ==
          plan.cuda[0].bytes);
    CHECK(bench.differing(*workers.front()) == 0);
    CHECK(static_cast<std::int64_t>(stand_in::peak_allocated_bytes()) - before ==
          plan.cuda[0].bytes);
}

TEST_CASE("a device with little memory gets one stream, and one with less takes no part")
{
    Bench bench;
    const auto device = cuda_test::device_of({});
    const auto cores = tile_cores(bench.pair.matcher(), bench.budget);
    const std::int64_t shared = matcher::cuda::shared_bytes(bench.pair.matcher());
    const std::int64_t each = matcher::cuda::worker_bytes(bench.pair.matcher(), device, cores);
    stand_in::DeviceTraits traits;
    traits.multiprocessors = device.multiprocessors;
    traits.memory_bytes =
        static_cast<std::size_t>((shared + each) * 10 / 9 + 100) + stand_in::allocated_bytes();
    stand_in::set_device_traits(traits);
    CHECK(plan_devices(device_choice("cuda"), bench.pair.matcher(), bench.budget)
              .cuda.at(0)
              .streams == 1);
    traits.memory_bytes = static_cast<std::size_t>(each) + stand_in::allocated_bytes();
    stand_in::set_device_traits(traits);
    const DevicePlan plan =
        plan_devices(device_choice("auto"), bench.pair.matcher(), bench.budget);
    CHECK(plan.cuda.empty());
    CHECK(plan.cpu);
    CHECK_THAT(plan.note, Contains("MiB free"));
    CHECK_THROWS_WITH(plan_devices(device_choice("cuda"), bench.pair.matcher(), bench.budget),
                      Contains("a CUDA device is asked for") && Contains("use auto or cpu"));
}

TEST_CASE(
    "without a driver or a device there is no device, and one that is asked for is refused")
{
    for (const int error : {34, 35, 100, 999}) {
        stand_in::DeviceTraits traits;
        traits.driver_error = error;
        stand_in::set_device_traits(traits);
        const auto devices = matcher::cuda::find_devices();
        CHECK(devices.usable.empty());
        CHECK_FALSE(devices.why_none.empty());
        CHECK_THROWS_WITH(chosen_devices(device_choice("cuda"), "'run.device' is 'cuda'"),
                          Contains("'run.device' is 'cuda', but no CUDA device can be used: " +
                                   devices.why_none));
        CHECK(chosen_devices(device_choice("auto"), "").usable.empty());
    }
    stand_in::DeviceTraits old;
    old.capability = 61;
    stand_in::set_device_traits(old);
    CHECK_THAT(matcher::cuda::find_devices().why_none, Contains("compute capability 6.1"));
    stand_in::reset();
    CHECK_THROWS_WITH(chosen_devices(device_choice("cuda:4"), "--device"),
                      Contains("count from 0 and there is 1"));
}

TEST_CASE("a device that fails while it is made ready takes no part, and somebody hears of it")
{
    for (const int allocation : {0, 1, 2}) {
        Bench bench;
        stand_in::set_faults({allocation, -1});
        const auto workers = bench.workers("auto");
        REQUIRE_FALSE(workers.empty());
        CHECK(workers.back()->name() == "cpu 0");
        REQUIRE(bench.troubles.size() == 1);
        CHECK_THAT(bench.troubles[0], Contains("cuda:0: ") && Contains("out of memory") &&
                                          Contains("takes no part"));
        CHECK(bench.differing(*workers.front()) == 0);
    }
}

TEST_CASE("tiles of a lost device are matched on the processor, and recorded")
{
    int launches = 0; // for all tiles
    {
        Bench bench;
        const auto workers = bench.workers("cuda");
        const auto before = stand_in::launches();
        CHECK(bench.differing(*workers.front()) == 0);
        launches = static_cast<int>(stand_in::launches() - before);
    }
    for (const int launch : {0, 3, launches - 1}) {
        Bench bench;
        const auto workers = bench.workers("cuda");
        INFO("launch " << launch);
        stand_in::set_faults({-1, launch});
        CHECK(bench.differing(*workers.front()) == 0);
        CHECK(bench.differing(*workers.back()) == 0);
        // Each stream fails once; afterwards it does not ask the device again.
        REQUIRE(bench.troubles.size() == 2);
        CHECK_THAT(bench.troubles[0], Contains("cuda:0") && Contains("launch failure"));
    }
}
