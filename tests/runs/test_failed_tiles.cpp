#include "tests/runs/run_place.h"

#include "matcher/reasons.h"
#include "pipeline/error.h"
#include "pipeline/worker_pool.h"
#include "tests/end_to_end/rasters.h"

#include "tests/catch.h"

#include <atomic>
#include <mutex>
#include <new>
#include <set>
#include <thread>

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;
using ledger::TileState;
using pipeline::MatchWorker;
using pipeline::RunResult;

namespace {

// A worker with something in its way.
class Disturbed final : public MatchWorker {
public:
    using Before = std::function<void(const MatchWorker&, const pipeline::TileTask&)>;
    Disturbed(std::shared_ptr<MatchWorker> inner, Before before)
        : inner_(std::move(inner)), before_(std::move(before))
    {
    }
    std::string name() const override { return inner_->name(); }
    matcher::TileMatch match(const pipeline::TileTask& task) override
    {
        before_(*inner_, task);
        return inner_->match(task);
    }
    void cancel() override { inner_->cancel(); }

private:
    std::shared_ptr<MatchWorker> inner_;
    Before before_;
};

pipeline::RunManner disturbed(const RunPlace& place, Disturbed::Before before)
{
    pipeline::RunManner manner = place.manner();
    manner.adapt_worker = [before = std::move(before)](std::shared_ptr<MatchWorker> worker) {
        return std::make_shared<Disturbed>(std::move(worker), before);
    };
    return manner;
}

RunResult carry_out(const RunPlace& place, const pipeline::RunManner& manner)
{
    return pipeline::run_job(place.planned(), manner, {});
}

bool is_the_tile(const pipeline::TileTask& task)
{
    return task.core.row == 64 && task.core.col == 128;
}

} // namespace

TEST_CASE("a tile that fails once is done by another worker, with the same bits")
{
    const RunPlace place;
    std::mutex mutex;
    std::set<std::string> tried;
    const RunResult result = carry_out(
        place, disturbed(place, [&](const MatchWorker& worker, const pipeline::TileTask& task) {
            const std::scoped_lock lock(mutex);
            if (is_the_tile(task)) {
                tried.insert(worker.name());
                if (tried.size() == 1) {
                    throw std::runtime_error("the device was lost");
                }
            }
        }));
    CHECK(result.failed.empty());
    CHECK(tried.size() == 2);
    CHECK((place.rasters() == place.undisturbed()));
    const auto attempts = place.ledger().attempts;
    CHECK(std::count_if(attempts.begin(), attempts.end(), [](const auto& attempt) {
              return attempt.reason == "the device was lost" && attempt.outcome == "failed";
          }) == 1);
}

TEST_CASE("a tile that finds no memory beside others is done alone, with the same bits")
{
    const RunPlace place;
    std::atomic<int> refusals{0};
    const RunResult result = carry_out(
        place, disturbed(place, [&](const MatchWorker&, const pipeline::TileTask& task) {
            // What a tile that needs more than the plan thought meets.
            if (is_the_tile(task) && ++refusals <= 2) {
                throw std::bad_alloc();
            }
        }));
    CHECK(result.failed.empty());
    CHECK(refusals == 3);
    CHECK((place.rasters() == place.undisturbed()));
}

TEST_CASE("a tile that fails for good is told, marked in the results, and made up for later")
{
    const RunPlace place;
    int others = 0;
    const RunResult result = carry_out(
        place, disturbed(place, [&](const MatchWorker&, const pipeline::TileTask& task) {
            if (is_the_tile(task)) {
                throw std::runtime_error("it will not do");
            }
        }));
    REQUIRE(result.failed.size() == 1);
    CHECK(result.failed[0].rect == tiling::Rect{64, 128, 64, 64});
    CHECK(result.failed[0].reason == "it will not do");
    CHECK(result.failed[0].attempts == 3);
    CHECK_THAT(pipeline::failure_sentence(result),
               Contains("1 of 35 tiles failed: rows 64-127, columns 128-191 (it will not do)"));
    const tiling::Image<double> reasons = pixels_of(place.result() + "/reasons.tif");
    const tiling::Image<double> disparity = pixels_of(place.result() + "/disparity.tif");
    for (int row = 0; row < reasons.rows(); ++row) {
        for (int col = 0; col < reasons.cols(); ++col) {
            const bool inside = result.failed[0].rect.contains(row, col);
            const bool marked =
                (static_cast<int>(reasons(row, col)) & matcher::kFailedTile) != 0;
            others += marked != inside || (inside && !std::isnan(disparity(row, col)));
        }
    }
    CHECK(others == 0);
    // The program, which can match it, is asked to make up for it.
    const int attempts_before = static_cast<int>(place.ledger().attempts.size());
    place.run_to(2); // not without being asked
    place.run_to(0, {"--resume"});
    CHECK((place.rasters() == place.undisturbed()));
    const auto attempts = place.ledger().attempts;
    CHECK(std::count_if(attempts.begin() + attempts_before, attempts.end(),
                        [](const auto& a) { return a.stage == pipeline::kMatchStage; }) == 1);
}

TEST_CASE("a worker that hangs past the limit is left behind and the run goes on")
{
    const RunPlace place({200, 200});
    std::atomic<bool> hang{true};
    std::atomic<int> hung{0};
    pipeline::PlannedJob planned = place.planned();
    planned.job.run.tile_limit_s = 0.2;
    planned.job.run.tile_grace_s = 0.2;
    const pipeline::RunManner manner =
        disturbed(place, [&](const MatchWorker&, const pipeline::TileTask& task) {
            if (is_the_tile(task) && hung++ == 0) {
                while (hang) {
                    std::this_thread::sleep_for(std::chrono::milliseconds(5));
                }
            }
        });
    const RunResult result = pipeline::run_job(planned, manner, {});
    hang = false; // lets the thread go before the test's variables do
    CHECK(result.failed.empty());
    CHECK(hung == 2);
    CHECK((place.rasters() == place.undisturbed()));
    const auto attempts = place.ledger().attempts;
    CHECK(std::count_if(attempts.begin(), attempts.end(), [](const auto& attempt) {
              return attempt.reason == "it took longer than the limit of 0.2 s";
          }) == 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

TEST_CASE("where every worker hangs the run ends and can be resumed")
{
    const RunPlace place({200, 200});
    std::atomic<bool> hang{true};
    pipeline::PlannedJob planned = place.planned();
    planned.job.run.tile_limit_s = 0.1;
    planned.job.run.tile_grace_s = 0.1;
    const pipeline::RunManner manner =
        disturbed(place, [&](const MatchWorker&, const pipeline::TileTask&) {
            while (hang) {
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            }
        });
    CHECK_THROWS_AS(pipeline::run_job(planned, manner, {}), pipeline::NoWorkerLeft);
    hang = false;
    place.run_to(0, {"--resume"});
    CHECK((place.rasters() == place.undisturbed()));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

TEST_CASE("a match without books leaves its results and ends with code 5 where a tile fails")
{
    const RunPlace place({200, 200});
    pipeline::RunManner manner =
        disturbed(place, [&](const MatchWorker&, const pipeline::TileTask& task) {
            if (is_the_tile(task)) {
                throw std::runtime_error("it will not do");
            }
        });
    manner.folder.clear();
    const RunResult result = carry_out(place, manner);
    CHECK(result.failed.size() == 1);
    CHECK(result.summary.has_value());
    CHECK(names_in(snapshot(place.result())) ==
          std::vector<std::string>{"confidence.tif", "disparity.tif", "reasons.tif"});
}
