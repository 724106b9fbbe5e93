#include "tests/catch.h"

#include "tests/unit/pipeline/fake_workers.h"

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>

using namespace hsgm::pipeline;
using namespace hsgm::pipeline::testing;
using std::chrono::milliseconds;

namespace {

// Collects what comes back, and waits for all of it.
class Deliveries {
public:
    std::function<void(MatchOutcome)> taker()
    {
        return [this](MatchOutcome outcome) {
            const std::scoped_lock lock(mutex_);
            outcomes_.push_back(std::move(outcome));
            changed_.notify_all();
        };
    }
    std::vector<MatchOutcome> wait_for(std::size_t count)
    {
        std::unique_lock lock(mutex_);
        REQUIRE(changed_.wait_for(lock, std::chrono::seconds(30),
                                  [&] { return outcomes_.size() >= count; }));
        return outcomes_;
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<MatchOutcome> outcomes_;
};

std::shared_ptr<const TileTask> task(int number, const std::string& avoid = "")
{
    TileTask t = numbered_task(number);
    t.avoid = avoid;
    return std::make_shared<const TileTask>(t);
}

std::string words_of(const std::exception_ptr& error)
{
    try {
        std::rethrow_exception(error);
    } catch (const std::exception& e) {
        return e.what();
    }
}

} // namespace

TEST_CASE("a slow and a fast worker are both kept busy")
{
    const Workers workers{std::make_shared<FakeWorker>(
                              0, [](int) { std::this_thread::sleep_for(milliseconds(40)); }),
                          std::make_shared<FakeWorker>(
                              1, [](int) { std::this_thread::sleep_for(milliseconds(2)); })};
    WorkerPool pool(workers);
    Deliveries deliveries;
    for (int i = 0; i < 60; ++i) {
        pool.submit(task(i), deliveries.taker());
    }
    std::map<std::string, int> served;
    for (const MatchOutcome& outcome : deliveries.wait_for(60)) {
        ++served[outcome.worker];
    }
    CHECK(served["fake 0"] >= 1);
    CHECK(served["fake 1"] > served["fake 0"]);
    CHECK(served["fake 0"] + served["fake 1"] == 60);
}

TEST_CASE("a worker is spared the tile that it failed at, unless it is the only one")
{
    Deliveries deliveries;
    {
        WorkerPool pool(fake_workers(2, [](int) {}));
        for (int i = 0; i < 20; ++i) {
            pool.submit(task(i, i % 2 == 0 ? "fake 0" : "fake 1"), deliveries.taker());
        }
        for (const MatchOutcome& outcome : deliveries.wait_for(20)) {
            CHECK(outcome.worker == (outcome.tile % 2 == 0 ? "fake 1" : "fake 0"));
        }
    }
    Deliveries alone;
    WorkerPool pool(fake_workers(1, [](int) {}));
    pool.submit(task(1, "fake 0"), alone.taker());
    CHECK(alone.wait_for(1)[0].worker == "fake 0");
}

TEST_CASE("a worker that fails three times in a row gets no more while another one works")
{
    Deliveries deliveries;
    const Workers workers{
        std::make_shared<FakeWorker>(0, [](int) { throw std::runtime_error("lost"); }),
        std::make_shared<FakeWorker>(
            1, [](int) { std::this_thread::sleep_for(milliseconds(1)); })};
    WorkerPool pool(workers);
    for (int i = 0; i < 50; ++i) {
        pool.submit(task(i), deliveries.taker());
    }
    int failed = 0;
    for (const MatchOutcome& outcome : deliveries.wait_for(50)) {
        failed += outcome.error != nullptr;
    }
    CHECK(failed == 3);
    CHECK(pool.usable() == 1);
}

TEST_CASE("the last worker goes on whatever it fails at")
{
    Deliveries deliveries;
    WorkerPool pool(fake_workers(1, [](int) { throw std::runtime_error("lost"); }));
    for (int i = 0; i < 10; ++i) {
        pool.submit(task(i), deliveries.taker());
    }
    for (const MatchOutcome& outcome : deliveries.wait_for(10)) {
        CHECK(words_of(outcome.error) == "lost");
    }
    CHECK(pool.usable() == 1);
}

TEST_CASE("outcomes say who did it and how long it took")
{
    Deliveries deliveries;
    WorkerPool pool(
        fake_workers(1, [](int) { std::this_thread::sleep_for(milliseconds(20)); }));
    const auto before = std::chrono::steady_clock::now();
    pool.submit(task(7), deliveries.taker());
    const MatchOutcome outcome = deliveries.wait_for(1)[0];
    CHECK(outcome.tile == 7);
    CHECK(outcome.worker == "fake 0");
    CHECK(outcome.started >= before);
    CHECK(outcome.seconds >= 0.02);
    CHECK(outcome.match.core == numbered_task(7).core);
}
