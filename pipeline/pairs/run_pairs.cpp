#include "pipeline/pairs/run_pairs.h"

#include "io/error.h"
#include "io/pending_file.h"
#include "pipeline/batch/batch.h"
#include "pipeline/batch/child_process.h"
#include "pipeline/error.h"
#include "pipeline/pairs/fuse_runs.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <fstream>
#include <thread>

namespace hsgm::pipeline {

namespace {

namespace fs = std::filesystem;

constexpr int kFailedTilesCode = 5;

fs::path file_of(const ListedPair& pair)
{
    return pair.folder.string() + ".yaml";
}

fs::path log_of(const ListedPair& pair)
{
    return pair.folder / "logs" / "job.log";
}

void make_folder(const fs::path& folder)
{
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) {
        throw io::StorageError(
            fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
    }
}

/// What stands in a run's log after `mark`.
std::string last_in_log(const ListedPair& pair, const std::string& mark)
{
    std::ifstream file(log_of(pair));
    std::string found;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with(mark)) {
            found = line.substr(mark.size());
        }
    }
    return found;
}

/// Its exit code.
int run_one(const ListedPair& pair, const PairsManner& manner)
{
    make_folder(log_of(pair).parent_path());
    io::write_text_file(file_of(pair).string(), pair.configuration.used_yaml);
    std::vector<std::string> command{this_program(), "--log-level", manner.log_level, "run",
                                     file_of(pair).string()};
    if (manner.resume) {
        command.emplace_back("--resume");
    }
    if (manner.restart) {
        command.emplace_back("--restart");
    }
    ChildProcess process(command, log_of(pair));
    bool stopping = false;
    while (!process.has_ended()) {
        if (stop_is_requested() && !std::exchange(stopping, true)) {
            process.stop();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    check_stop();
    return process.exit_code();
}

[[noreturn]] void fail_as(int code, const std::string& sentence)
{
    switch (code) {
    case 2:
        throw io::ConfigError(sentence);
    case 3:
        throw io::InputError(sentence);
    case 4:
        throw BudgetError(sentence);
    case 6:
        throw io::StorageError(sentence);
    default:
        throw FailedTiles(sentence);
    }
}

/// What came of all pairs so far.
struct Outcomes {
    std::vector<fs::path> finished;
    std::vector<std::string> failed; ///< "NAME: why"
    int first_code = 0;              ///< of those that failed
};

void note(const ListedPair& pair, int code, Outcomes& outcomes)
{
    if (code == 0 || code == kFailedTilesCode) {
        outcomes.finished.push_back(pair.folder);
    }
    if (code == 0) {
        spdlog::info("{}: done", pair.name);
        return;
    }
    BatchResult result;
    result.exit_code = code;
    const std::string why = last_in_log(pair, "error: ");
    outcomes.failed.push_back(
        fmt::format("{}: {}", pair.name, why.empty() ? state_of(result) : why));
    outcomes.first_code = outcomes.first_code == 0 ? code : outcomes.first_code;
    spdlog::warn("{}", outcomes.failed.back());
}

std::string joined(const std::vector<std::string>& words)
{
    std::string all;
    for (const std::string& word : words) {
        all += (all.empty() ? "" : "; ") + word;
    }
    return all;
}

void fuse(const PairList& list, const PairsManner& manner, const Outcomes& outcomes)
{
    const Job& job = list.of_all.job;
    FuseRequest request;
    request.runs = outcomes.finished;
    request.folder = list.folder;
    request.outputs = fused_outputs(list.folder, !job.outputs.hillshade.empty(),
                                    !job.outputs.hillshade_picture.empty());
    request.outputs.creation_options = job.outputs.creation_options;
    request.threads = job.run.threads;
    request.memory_bytes = job.run.memory_bytes;
    request.resume = manner.resume;
    fuse_runs(request);
}

} // namespace

void run_pairs(const PairList& list, const PairsManner& manner)
{
    for (const std::string& pair : list.left_out) {
        spdlog::info("left out: {}", pair);
    }
    Outcomes outcomes;
    for (const ListedPair& pair : list.pairs) {
        spdlog::info("pair {} of {}: {}", &pair - list.pairs.data() + 1, list.pairs.size(),
                     pair.name);
        note(pair, run_one(pair, manner), outcomes);
    }
    if (outcomes.finished.size() < 2) {
        fail_as(outcomes.first_code,
                fmt::format("{} of {} pairs are finished, and to fuse takes two{}{}",
                            outcomes.finished.size(), list.pairs.size(),
                            outcomes.failed.empty() ? "" : ": ", joined(outcomes.failed)));
    }
    fuse(list, manner, outcomes);
    if (!outcomes.failed.empty()) {
        throw FailedTiles(
            fmt::format("{} of {} pairs failed: {}; the DSM is made of what there "
                        "is, --resume tries them again",
                        outcomes.failed.size(), list.pairs.size(), joined(outcomes.failed)));
    }
}

} // namespace hsgm::pipeline
