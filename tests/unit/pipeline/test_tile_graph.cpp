#include "tests/catch.h"

#include "tests/unit/pipeline/fake_workers.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>

using namespace hsgm;
using namespace hsgm::pipeline;
using namespace hsgm::pipeline::testing;

namespace {

std::vector<int> numbers(int count)
{
    std::vector<int> sequence(static_cast<std::size_t>(count));
    std::iota(sequence.begin(), sequence.end(), 0);
    return sequence;
}

void keep_nobody(int) {}

// Calls from an arena of so many threads, on machines with fewer processors too.
template <typename Work>
void with_threads(int threads, Work work)
{
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    arena.execute(work);
}

void take_a_while(int tile)
{
    std::this_thread::sleep_for(std::chrono::microseconds(50 * (tile * 7 % 11)));
}

} // namespace

TEST_CASE("every tile is read, matched and written once")
{
    for (const int threads : {1, 2, 4}) {
        for (const int workers : {1, 3}) {
            for (const int in_flight : {1, 2, 5}) {
                std::vector<int> written(100);
                std::vector<std::atomic<int>> read(100);
                std::vector<std::atomic<int>> matched(100);
                TileSteps steps;
                steps.read = [&](int tile) {
                    ++read[static_cast<std::size_t>(tile)];
                    return numbered_task(tile);
                };
                steps.write = [&](int tile, const matcher::TileMatch& match) {
                    CHECK(match.core == numbered_task(tile).core);
                    ++written[static_cast<std::size_t>(tile)];
                };
                const auto pool = fake_workers(workers, [&](int tile) {
                    take_a_while(tile);
                    ++matched[static_cast<std::size_t>(tile)];
                });
                with_threads(threads,
                             [&] { run_tiles_with(numbers(100), steps, pool, in_flight); });
                const auto once = [](int n) { return n == 1; };
                CHECK(std::all_of(written.begin(), written.end(), once));
                CHECK(std::all_of(read.begin(), read.end(), once));
                CHECK(std::all_of(matched.begin(), matched.end(), once));
            }
        }
    }
}

TEST_CASE("no more tiles are in flight than allowed, and writing is one at a time")
{
    for (const int allowed : {1, 2, 4}) {
        std::atomic<int> in_flight{0};
        std::atomic<int> most{0};
        std::atomic<bool> writing{false};
        TileSteps steps;
        steps.read = [&](int tile) {
            const int now = ++in_flight;
            int seen = most;
            while (now > seen && !most.compare_exchange_weak(seen, now)) {
            }
            return numbered_task(tile);
        };
        bool alone = true;
        steps.write = [&](int tile, const matcher::TileMatch&) {
            alone &= !writing.exchange(true);
            take_a_while(tile);
            writing = false;
            --in_flight;
        };
        const auto pool = fake_workers(4, take_a_while);
        with_threads(4, [&] { run_tiles_with(numbers(60), steps, pool, allowed); });
        CHECK(most <= allowed);
        CHECK(most >= 1);
        CHECK(in_flight == 0);
        CHECK(alone);
    }
}

TEST_CASE("one tile in flight keeps the order of the sequence")
{
    const std::vector<int> sequence{4, 1, 3, 0, 2};
    std::vector<int> order;
    TileSteps steps{
        numbered_task, [&](int tile, const matcher::TileMatch&) { order.push_back(tile); }, {}};
    with_threads(4, [&] { run_tiles_with(sequence, steps, fake_workers(2, keep_nobody), 1); });
    CHECK(order == sequence);
}

TEST_CASE("an exception of any step ends the run and arrives at the caller")
{
    for (const std::string failing : {"read", "match", "write"}) {
        std::atomic<int> started{0};
        const auto fail_in = [&](const std::string& step, int tile) {
            if (step == failing && tile == 20) {
                throw std::runtime_error("cannot " + step + " tile 20");
            }
        };
        TileSteps steps;
        steps.read = [&](int tile) {
            ++started;
            fail_in("read", tile);
            if (tile > 500) { // time for a failing step on a busy machine to be heard
                std::this_thread::sleep_for(std::chrono::milliseconds(2));
            }
            return numbered_task(tile);
        };
        steps.write = [&](int tile, const matcher::TileMatch&) { fail_in("write", tile); };
        const auto pool = fake_workers(2, [&](int tile) { fail_in("match", tile); });
        CHECK_THROWS_WITH(
            with_threads(4, [&] { run_tiles_with(numbers(1000), steps, pool, 3); }),
            "cannot " + failing + " tile 20");
        CHECK(started < 1000);
    }
}

TEST_CASE("a run without tiles ends at once")
{
    TileSteps steps{numbered_task, [](int, const matcher::TileMatch&) { FAIL("no tile"); }, {}};
    run_tiles_with({}, steps, fake_workers(1, keep_nobody), 2);
}

TEST_CASE("where failures are asked for, they are told and the others go on")
{
    for (const std::string failing : {"read", "match"}) {
        std::vector<int> written;
        std::vector<int> failed;
        TileSteps steps;
        steps.read = [&](int tile) {
            if (failing == "read" && tile % 5 == 0) {
                throw std::runtime_error("cannot read");
            }
            return numbered_task(tile);
        };
        steps.write = [&](int tile, const matcher::TileMatch&) { written.push_back(tile); };
        steps.ended = [&](const MatchOutcome& outcome) {
            if (outcome.error) {
                failed.push_back(outcome.tile);
            }
        };
        const auto pool = fake_workers(1, [&](int tile) {
            if (failing == "match" && tile % 5 == 0) {
                throw std::runtime_error("cannot match");
            }
        });
        with_threads(2, [&] { run_tiles_with(numbers(50), steps, pool, 3); });
        std::sort(failed.begin(), failed.end());
        CHECK(failed == std::vector<int>{0, 5, 10, 15, 20, 25, 30, 35, 40, 45});
        CHECK(written.size() == 40);
    }
}
