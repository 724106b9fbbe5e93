#include "pipeline/ledger/recorder.h"
#include "tests/unit/io/sample_rasters.h"

#include "tests/catch.h"

#include <atomic>
#include <thread>

using namespace hsgm::ledger;
using hsgm::io::samples::TemporaryFolder;
using hsgm::tiling::Rect;
using std::chrono::milliseconds;

namespace {

Rect tile(int i)
{
    return {0, i * 10, 10, 10};
}

TileEvent event(int i, TileState state)
{
    TileEvent e;
    e.stage = "match";
    e.rect = tile(i);
    e.state = state;
    return e;
}

std::vector<Rect> tiles(int count)
{
    std::vector<Rect> all;
    for (int i = 0; i < count; ++i) {
        all.push_back(tile(i));
    }
    return all;
}

int in_state(const Ledger& ledger, TileState state)
{
    const auto rows = ledger.tiles("match");
    return static_cast<int>(std::count_if(rows.begin(), rows.end(),
                                          [&](const TileRow& r) { return r.state == state; }));
}

} // namespace

TEST_CASE("after a flush everything is recorded, and results were made durable before")
{
    const TemporaryFolder folder;
    Ledger ledger(folder / "x.sqlite");
    ledger.take({}, false);
    ledger.plan("match", tiles(40));
    std::atomic<int> stored{0};
    std::atomic<int> durable{0};
    int too_early = 0;
    Recorder recorder(
        ledger,
        [&] {
            too_early += in_state(ledger, TileState::done) > durable;
            durable = stored.load();
        },
        milliseconds(1));
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&, t] {
            for (int i = t * 10; i < t * 10 + 10; ++i) {
                recorder.add(event(i, TileState::running));
                ++stored;
                recorder.add(event(i, TileState::done));
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    recorder.flush();
    CHECK(in_state(ledger, TileState::done) == 40);
    CHECK(durable == 40);
    CHECK(too_early == 0);
}

TEST_CASE("what runs shows in the ledger soon, without a flush")
{
    const TemporaryFolder folder;
    Ledger ledger(folder / "x.sqlite");
    ledger.take({}, false);
    ledger.plan("match", tiles(2));
    Recorder recorder(ledger, nullptr, milliseconds(1));
    recorder.add(event(0, TileState::running));
    for (int i = 0; i < 2000 && in_state(ledger, TileState::running) == 0; ++i) {
        std::this_thread::sleep_for(milliseconds(5));
    }
    CHECK(in_state(ledger, TileState::running) == 1);
}

TEST_CASE("a failure in the background reaches whoever adds or flushes next")
{
    const TemporaryFolder folder;
    Ledger ledger(folder / "x.sqlite");
    ledger.take({}, false);
    ledger.plan("match", tiles(1));
    Recorder recorder(ledger, [] { throw hsgm::io::StorageError("the disk is full"); });
    recorder.add(event(0, TileState::done));
    CHECK_THROWS_WITH(recorder.flush(), "the disk is full");
    CHECK_THROWS_WITH(recorder.add(event(0, TileState::running)), "the disk is full");
    CHECK(in_state(ledger, TileState::done) == 0);
}

TEST_CASE("times to record follow a clock that is never set")
{
    const TemporaryFolder folder;
    Ledger ledger(folder / "x.sqlite");
    const Recorder recorder(ledger, nullptr);
    const auto now = Recorder::Clock::now();
    const double later = recorder.time_of(now + std::chrono::seconds(2));
    CHECK(std::abs(later - recorder.time_of(now) - 2) < 1e-3);
    CHECK(recorder.time_of(now) > 1.7e9);
}
