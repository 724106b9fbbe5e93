#include "tests/runs/run_place.h"

#include "io/config.h"
#include "io/error.h"
#include "pipeline/configuration.h"
#include "pipeline/stages/fingerprint_stage.h"

#include "tests/catch.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

namespace hsgm::tests {

namespace {

bool is_match(const ledger::TileRow& row)
{
    return row.stage == pipeline::kMatchStage;
}

io::ConfigDocument configuration(const std::string& path)
{
    auto document = io::ConfigDocument::load(path);
    document.set("run.tile_size", "64");
    document.set("run.threads", "2");
    return document;
}

} // namespace

RunPlace::RunPlace(tiling::Size size, int disparity_max)
{
    make_pair(folder_, size);
    put_bytes(folder_ / "run.yaml", "pair: {left: left.tif, right: right.tif}\n"
                                    "geometry: {kind: rectified}\n"
                                    "output: {folder: result}\n"
                                    "matcher: {disparity: [0, " +
                                        std::to_string(disparity_max) + "], prune: false}\n");
}

RunPlace::RunPlace(const std::string& result, tiling::Size size, int disparity_max)
    : RunPlace(size, disparity_max)
{
    result_ = result;
}

std::vector<std::string> RunPlace::command(const std::vector<std::string>& more) const
{
    std::vector<std::string> words{hsgm_program(), "run", folder_ / "run.yaml"};
    const auto has = [&](const char* option) {
        return std::find(more.begin(), more.end(), option) != more.end();
    };
    if (!has("--tile-size")) {
        words.insert(words.end(), {"--tile-size", "64"});
    }
    if (!has("--threads")) {
        words.insert(words.end(), {"--threads", "2"});
    }
    if (!has("-o")) {
        words.insert(words.end(), {"-o", result()});
    }
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

Outcome RunPlace::run(const std::vector<std::string>& more) const
{
    return run_program(command(more));
}

Outcome RunPlace::run_to(int code, const std::vector<std::string>& more) const
{
    Outcome outcome = run(more);
    INFO(outcome.err);
    CHECK(outcome.code == code);
    return outcome;
}

int RunPlace::run_and_kill(int tiles_done, const std::vector<std::string>& more) const
{
    RunningProgram program(command(more));
    bool ended = false;
    const bool reached = comes_true([&] {
        ended = program.has_ended();
        return ended || done() >= tiles_done;
    });
    REQUIRE(reached);
    program.signal(SIGKILL);
    program.wait();
    return done();
}

const Snapshot& RunPlace::undisturbed() const
{
    if (undisturbed_.empty()) {
        run_to(0, {"-o", folder_ / "undisturbed", "--tile-size", "128"});
        undisturbed_ = rasters_in(folder_ / "undisturbed");
        REQUIRE(undisturbed_.size() >= 3);
    }
    return undisturbed_;
}

ledger::Contents RunPlace::ledger(tiling::Shard shard) const
{
    const pipeline::RunLayout layout{result()};
    try {
        return ledger::read_ledger(layout.tiles_ledger(shard));
    } catch (const io::StorageError&) {
        return {}; // not there yet, or just being made
    }
}

std::vector<ledger::TileRow> RunPlace::tiles(tiling::Shard shard) const
{
    auto rows = ledger(shard).tiles;
    std::erase_if(rows, [](const ledger::TileRow& row) { return !is_match(row); });
    return rows;
}

int RunPlace::done(tiling::Shard shard) const
{
    const auto rows = tiles(shard);
    return static_cast<int>(std::count_if(rows.begin(), rows.end(), [](const auto& row) {
        return row.state == ledger::TileState::done;
    }));
}

pipeline::PlannedJob RunPlace::planned() const
{
    auto document = configuration(folder_ / "run.yaml");
    return pipeline::plan_job(pipeline::read_configuration(document).job);
}

pipeline::RunManner RunPlace::manner() const
{
    auto document = configuration(folder_ / "run.yaml");
    const auto read = pipeline::read_configuration(document);
    std::filesystem::create_directories(read.folder);
    pipeline::RunManner manner;
    manner.folder = read.folder;
    manner.settings = pipeline::settings_of(document);
    return manner;
}

bool comes_true(const std::function<bool()>& condition)
{
    for (int i = 0; i < 6000; ++i) {
        if (condition()) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
}

} // namespace hsgm::tests
