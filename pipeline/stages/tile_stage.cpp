#include "pipeline/stages/tile_stage.h"

#include "io/error.h"
#include "pipeline/cuda_worker.h"
#include "pipeline/error.h"
#include "pipeline/freed_memory.h"
#include "pipeline/ledger/recorder.h"
#include "pipeline/run_log.h"
#include "pipeline/stages/tile_list.h"
#include "pipeline/tile_graph.h"

#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <map>
#include <mutex>
#include <set>

namespace hsgm::pipeline {

namespace {

using ledger::TileEvent;
using ledger::TileRow;
using ledger::TileState;
using tiling::Rect;

std::string words_of(const std::exception_ptr& error)
{
    try {
        std::rethrow_exception(error);
    } catch (const std::bad_alloc&) {
        return "the machine gave no more memory";
    } catch (const std::exception& failure) {
        return failure.what();
    } catch (...) {
        return "an exception of an unknown kind";
    }
}

std::string place_of(const Rect& r)
{
    return "rows " + std::to_string(r.row) + "-" + std::to_string(r.row_end() - 1) +
           ", columns " + std::to_string(r.col) + "-" + std::to_string(r.col_end() - 1);
}

void tell_log(const Rect& tile, const MatchOutcome& outcome)
{
    nlohmann::ordered_json fields{{"state", outcome.error ? "failed" : "done"},
                                  {"row", tile.row},
                                  {"col", tile.col},
                                  {"rows", tile.rows},
                                  {"cols", tile.cols},
                                  {"worker", outcome.worker},
                                  {"seconds", outcome.seconds}};
    if (outcome.error) {
        fields["reason"] = words_of(outcome.error);
    }
    log_event("tile", fields);
}

/// Tiles on their way through the graph, and the book that is kept of them.
class TileRun {
public:
    TileRun(const PairBasis& pair, FirstPassPart& part, ledger::Recorder& recorder,
            std::vector<ListedTile> tiles, const Progress& progress)
        : pair_(pair), part_(part), recorder_(recorder), tiles_(std::move(tiles)),
          progress_(progress)
    {
        state_.all = static_cast<int>(tiles_.size());
        for (const ListedTile& tile : tiles_) {
            state_.pixels_all += tile.core.area();
        }
    }

    void carry_out(WorkerPool& pool, int tiles_in_flight);

private:
    TileSteps steps();
    TileTask read(int tile);
    void ended(const MatchOutcome& outcome);
    void record(int tile, TileState state, const MatchOutcome& outcome, std::string reason);
    void attempt(const std::vector<int>& sequence, WorkerPool& pool, int tiles_in_flight);
    void drop_what_is_in_flight();
    void tell();

    const PairBasis& pair_;
    FirstPassPart& part_;
    ledger::Recorder& recorder_;
    std::vector<ListedTile> tiles_;
    const Progress& progress_;
    bool last_attempt_ = false;
    std::vector<int> to_try_again_;
    std::map<int, std::string> checksums_;
    std::mutex mutex_; // reads run side by side
    std::set<int> in_flight_;
    TileProgress state_;
};

TileTask TileRun::read(int tile)
{
    const ListedTile& listed = tiles_[static_cast<std::size_t>(tile)];
    {
        const std::scoped_lock lock(mutex_);
        in_flight_.insert(tile);
        state_.in_flight = static_cast<int>(in_flight_.size());
    }
    MatchOutcome begun;
    begun.started = std::chrono::steady_clock::now();
    record(tile, TileState::running, begun, "");
    TileTask task;
    task.index = tile;
    task.core = listed.core;
    task.avoid = listed.avoid;
    const auto support = pair_.matcher->support(task.core);
    for (int level = 0; level < pair_.matcher->plan().windowed_levels(); ++level) {
        task.images.push_back(
            pair_.images->read(level, support[static_cast<std::size_t>(level)]));
    }
    return task;
}

void TileRun::record(int tile, TileState state, const MatchOutcome& outcome, std::string reason)
{
    TileEvent event;
    event.stage = kMatchStage;
    event.rect = tiles_[static_cast<std::size_t>(tile)].core;
    event.state = state;
    event.worker = outcome.worker;
    event.started_s = recorder_.time_of(outcome.started);
    event.seconds = outcome.seconds;
    event.reason = std::move(reason);
    if (state == TileState::done) {
        event.checksum = checksums_[tile];
        checksums_.erase(tile);
    }
    recorder_.add(std::move(event));
}

void TileRun::ended(const MatchOutcome& outcome)
{
    ListedTile& tile = tiles_[static_cast<std::size_t>(outcome.tile)];
    {
        const std::scoped_lock lock(mutex_);
        in_flight_.erase(outcome.tile);
        state_.in_flight = static_cast<int>(in_flight_.size());
    }
    tell_log(tile.core, outcome);
    if (!outcome.error) {
        record(outcome.tile, TileState::done, outcome, "");
        ++state_.done;
        state_.pixels_done += tile.core.area();
        tell();
        return;
    }
    const std::string reason = words_of(outcome.error);
    record(outcome.tile, last_attempt_ ? TileState::failed : TileState::pending, outcome,
           reason);
    spdlog::warn("the tile at {} failed{}: {}; {}", place_of(tile.core),
                 outcome.worker.empty() ? "" : " on " + outcome.worker, reason,
                 last_attempt_ ? "it is left out" : "it will be tried again");
    if (last_attempt_) {
        ++state_.done;
        ++state_.failed;
        tell();
        return;
    }
    tile.avoid = outcome.worker;
    to_try_again_.push_back(outcome.tile);
}

void TileRun::tell()
{
    if (progress_) {
        progress_(state_);
    }
}

TileSteps TileRun::steps()
{
    TileSteps steps;
    steps.read = [this](int tile) { return read(tile); };
    steps.write = [this](int tile, const matcher::TileMatch& match) {
        part_.store(match);
        checksums_[tile] = checksum(match);
    };
    steps.ended = [this](const MatchOutcome& outcome) { ended(outcome); };
    return steps;
}

void TileRun::drop_what_is_in_flight()
{
    for (const int tile : in_flight_) {
        record(tile, TileState::pending, {}, "");
    }
    in_flight_.clear();
}

void TileRun::attempt(const std::vector<int>& sequence, WorkerPool& pool, int tiles_in_flight)
{
    try {
        run_tiles(sequence, steps(), pool, tiles_in_flight);
        recorder_.flush();
    } catch (...) {
        try {
            drop_what_is_in_flight();
            recorder_.flush();
        } catch (const io::StorageError& error) {
            spdlog::debug("{}", error.what()); // the first failure says more
        }
        throw;
    }
}

void TileRun::carry_out(WorkerPool& pool, int tiles_in_flight)
{
    std::vector<int> first;
    std::vector<int> suspects;
    for (int tile = 0; tile < static_cast<int>(tiles_.size()); ++tile) {
        (tiles_[static_cast<std::size_t>(tile)].suspect ? suspects : first).push_back(tile);
    }
    attempt(first, pool, tiles_in_flight);
    std::vector<int> again = std::exchange(to_try_again_, {});
    attempt(again, pool, tiles_in_flight);
    again = std::exchange(to_try_again_, {});
    again.insert(again.end(), suspects.begin(), suspects.end());
    last_attempt_ = true;
    for (ListedTile& tile : tiles_) {
        tile.avoid.clear();
    }
    attempt(again, pool, 1);
}

std::vector<std::shared_ptr<MatchWorker>>
workers_for(const PlannedJob& planned, const RunManner& manner, const PairBasis& pair,
            const std::shared_ptr<const matcher::CoarseSolution>& coarse)
{
    const auto arena = std::make_shared<tbb::task_arena>(planned.budget.threads);
    const auto trouble = [](const std::string& why) { spdlog::warn("{}", why); };
    auto workers =
        make_workers(planned.devices, planned.budget, {pair.matcher, coarse, arena}, trouble);
    if (manner.adapt_worker) {
        for (auto& worker : workers) {
            worker = manner.adapt_worker(worker);
        }
    }
    return workers;
}

} // namespace

void match_tiles(const PlannedJob& planned, const RunLayout& layout, tiling::Shard shard,
                 const RunManner& manner, const OwnedLedger& book, const Progress& progress)
{
    const Rect band = band_of(planned.shape.left, shard);
    const ShardParts parts(planned, layout, shard, book.owner().part);
    std::vector<ListedTile> tiles = list_tiles(planned, band, *book, parts);
    if (tiles.empty()) {
        return;
    }
    const PairBasis pair =
        open_pair(planned, layout, ledger::read_ledger(layout.coarse_ledger()).facts);
    std::shared_ptr<const matcher::CoarseSolution> coarse;
    book.record("coarse", band, [&] { coarse = solve_coarse(pair); });
    give_back_freed_memory();
    const auto part = parts.own();
    std::function<void()> make_durable;
    if (manner.is_durable()) {
        make_durable = [part] { part->sync(); };
    }
    ledger::Recorder recorder(*book, make_durable);
    TileRun run(pair, *part, recorder, std::move(tiles), progress);
    WorkerPool pool(workers_for(planned, manner, pair, coarse),
                    {planned.job.run.tile_limit_s, planned.job.run.tile_grace_s});
    run.carry_out(pool, planned.budget.tiles_in_flight);
}

void add_results(const PlannedJob& planned, const RunLayout& layout, tiling::Shard shard,
                 const std::vector<TileRow>& tiles, FirstPass& results)
{
    std::map<int, std::vector<Rect>> done;
    for (const TileRow& row : tiles) {
        if (row.stage == kMatchStage && row.state == TileState::done) {
            done[row.part].push_back(row.rect);
        }
    }
    const Rect band = band_of(planned.shape.left, shard);
    for (auto& [number, rects] : done) {
        results.add(std::make_shared<FirstPassPart>(planned.shape, band,
                                                    layout.part(shard, number),
                                                    io::ScratchLife::existing),
                    std::move(rects));
    }
}

} // namespace hsgm::pipeline
