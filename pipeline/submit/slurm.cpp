#include "pipeline/submit/slurm.h"

#include "io/error.h"
#include "io/pending_file.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cstdio>
#include <system_error>

namespace hsgm::pipeline {

namespace {

std::string name_of(RunStage stage)
{
    switch (stage) {
    case RunStage::coarse:
        return "coarse";
    case RunStage::tiles:
        return "tiles";
    default:
        return "assemble";
    }
}

// One word for a shell.
std::string quoted(const std::string& word)
{
    constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                   "0123456789_-./=,:@%+";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
        return word;
    }
    std::string text = "'";
    for (const char c : word) {
        if (c == '\'') {
            text += "'\\''";
        } else {
            text += c;
        }
    }
    text += '\'';
    return text;
}

std::string path_of_script(const SlurmChain& chain, RunStage stage)
{
    return chain.results + "/slurm/" + name_of(stage) + ".sbatch";
}

constexpr const char* kCoarse = R"(# First: prepares the pair for all shards.
)";

constexpr const char* kTiles = R"(# Then: each task of the array matches its share of the tiles.
# A task that Slurm starts again goes on where its earlier self stopped.
)";

constexpr const char* kAssemble =
    R"(# Last, when the array has ended, however that was: writes the results.
# Exit code 5: some tiles failed, and the results say where.
)";

const char* body_of(RunStage stage)
{
    switch (stage) {
    case RunStage::coarse:
        return kCoarse;
    case RunStage::tiles:
        return kTiles;
    default:
        return kAssemble;
    }
}

// What sbatch prints: the job's number, or why there is none.
std::string output_of(const std::string& command, int& status)
{
    FILE* pipe = ::popen((command + " 2>&1").c_str(), "r");
    if (pipe == nullptr) {
        throw io::StorageError("no process can be started for sbatch");
    }
    std::string text;
    std::array<char, 512> part{};
    while (std::fgets(part.data(), part.size(), pipe) != nullptr) {
        text += part.data();
    }
    status = ::pclose(pipe);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) {
        text.pop_back();
    }
    return text;
}

std::string file_job(const SlurmChain& chain, RunStage stage, const std::string& options)
{
    int status = 0;
    const std::string answer = output_of(
        fmt::format("sbatch --parsable {} {}", options, quoted(path_of_script(chain, stage))),
        status);
    const std::string number = answer.substr(0, answer.find(';')); // ;cluster may follow
    const bool is_number =
        !number.empty() && number.find_first_not_of("0123456789") == std::string::npos;
    if (status != 0 || !is_number) {
        throw io::StorageError(fmt::format("Slurm does not take {}: {}",
                                           path_of_script(chain, stage),
                                           answer.empty() ? "sbatch said nothing" : answer));
    }
    return number;
}

} // namespace

std::string slurm_script(const SlurmChain& chain, RunStage stage)
{
    const bool tiles = stage == RunStage::tiles;
    std::string text = "#!/bin/bash\n";
    const auto directive = [&](const std::string& option) {
        text += "#SBATCH " + option + "\n";
    };
    directive("--job-name=hsgm-" + name_of(stage));
    if (tiles) {
        directive(fmt::format("--array=0-{}", chain.shards - 1));
    }
    directive("--ntasks=1");
    directive(fmt::format("--cpus-per-task={}", chain.threads));
    directive(fmt::format("--mem={}M", chain.memory_mib));
    directive("--requeue");
    directive("--open-mode=append");
    directive("--signal=B:TERM@60");
    directive(
        fmt::format("--output={}/logs/slurm-%x-{}.log", chain.results, tiles ? "%A_%a" : "%j"));
    for (const std::string& more : chain.directives) {
        directive(more);
    }
    text += body_of(stage);
    std::vector<std::string> words{chain.program, "run",     chain.config,  "-o",
                                   chain.results, "--stage", name_of(stage)};
    if (tiles) {
        words.insert(words.end(), {"--shard", fmt::format("auto/{}", chain.shards)});
    }
    words.insert(words.end(), {"--resume", "--threads", std::to_string(chain.threads),
                               "--memory", fmt::format("{}MiB", chain.memory_mib)});
    words.insert(words.end(), chain.words.begin(), chain.words.end());
    text += "exec";
    for (const std::string& word : words) {
        text += ' ';
        text += quoted(word);
    }
    return text + "\n";
}

void write_slurm_scripts(const SlurmChain& chain)
{
    for (const char* folder : {"/slurm", "/logs"}) {
        std::error_code error;
        std::filesystem::create_directories(chain.results + folder, error);
        if (error) {
            throw io::StorageError(fmt::format("cannot make the folder {}{}: {}", chain.results,
                                               folder, error.message()));
        }
    }
    for (const RunStage stage : {RunStage::coarse, RunStage::tiles, RunStage::assemble}) {
        io::write_text_file(path_of_script(chain, stage), slurm_script(chain, stage));
    }
}

FiledChain file_slurm_chain(const SlurmChain& chain)
{
    FiledChain filed;
    filed.coarse = file_job(chain, RunStage::coarse, "");
    filed.tiles = file_job(chain, RunStage::tiles,
                           "--kill-on-invalid-dep=yes --dependency=afterok:" + filed.coarse);
    filed.assemble =
        file_job(chain, RunStage::assemble, "--dependency=afterany:" + filed.tiles);
    return filed;
}

} // namespace hsgm::pipeline
