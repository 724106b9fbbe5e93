#include "pipeline/commands/submit_command.h"

#include "pipeline/batch/child_process.h"
#include "pipeline/commands/knobs.h"
#include "pipeline/commands/reporting.h"
#include "pipeline/configuration.h"
#include "pipeline/stages/plan_stage.h"
#include "pipeline/submit/slurm.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace hsgm::pipeline {

namespace {

constexpr const char* kHelp = R"(Examples:
  hsgm submit city.yaml --engine slurm --shards 16 --threads 8 --memory 8GiB
  hsgm submit city.yaml --engine slurm -o /shared/city --sbatch=--partition=long --dry-run

Plans the run here, writes three scripts into RESULTS/slurm and files them: the coarse stage,
then an array with a task for each shard, then the assembly. RESULTS, CONFIG and the images must
be on a file system that all nodes see. --dry-run writes the scripts and files nothing.
Filing the same run again resumes it. hsgm status RESULTS tells how far it is.)";

struct Arguments {
    std::string config;
    std::string output;
    std::string engine;
    std::string program;
    std::vector<std::string> sbatch;
    int shards = 8;
    bool dry_run = false;
    Knobs knobs;
};

// What the jobs ask Slurm for where nobody says: the plan's bound, with room for the system's
// own share of a job.
std::int64_t memory_mib(const Budget& budget, bool given)
{
    constexpr std::int64_t kMiB = std::int64_t{1} << 20;
    const std::int64_t bytes =
        given ? budget.memory_bytes : budget.estimate_bytes + budget.estimate_bytes / 4;
    return (bytes + kMiB - 1) / kMiB;
}

// Knobs whose values the jobs get as they were given here; threads and memory are settled.
std::vector<std::string> words_of(const Knobs& knobs)
{
    std::vector<std::string> words;
    const auto add = [&](const char* option, const std::string& value) {
        if (!value.empty()) {
            words.insert(words.end(), {option, value});
        }
    };
    add("--profile", knobs.profile);
    add("--tile-size", knobs.tile_size);
    add("--device", knobs.device);
    for (const std::string& assignment : knobs.overrides) {
        add("--set", assignment);
    }
    return words;
}

void submit(const Arguments& arguments)
{
    namespace fs = std::filesystem;
    auto document = io::ConfigDocument::load(arguments.config);
    arguments.knobs.apply(document);
    if (!arguments.output.empty()) {
        document.set("output.folder", "'" + fs::absolute(arguments.output).string() + "'");
    }
    const bool memory_given = document.is_scalar("run.memory");
    const Configuration configuration = read_configuration(document);
    const PlannedJob planned = plan_job(configuration.job);
    SlurmChain chain;
    chain.program = arguments.program.empty() ? this_program() : arguments.program;
    chain.config = fs::absolute(arguments.config).lexically_normal().string();
    chain.results = fs::absolute(configuration.folder).lexically_normal().string();
    chain.words = words_of(arguments.knobs);
    chain.directives = arguments.sbatch;
    chain.shards = arguments.shards;
    chain.threads = planned.budget.threads;
    chain.memory_mib = memory_mib(planned.budget, memory_given);
    log_plan(planned);
    write_slurm_scripts(chain);
    if (arguments.dry_run) {
        fmt::print("{}/slurm: coarse.sbatch, tiles.sbatch, assemble.sbatch\n", chain.results);
        return;
    }
    const FiledChain filed = file_slurm_chain(chain);
    fmt::print("coarse {}\ntiles {} ({} tasks)\nassemble {}\n", filed.coarse, filed.tiles,
               chain.shards, filed.assemble);
}

} // namespace

CLI::App* add_submit_command(CLI::App& app)
{
    CLI::App* command = app.add_subcommand("submit", "File a run as jobs of a cluster");
    command->footer(kHelp);
    const auto arguments = std::make_shared<Arguments>();
    command->add_option("CONFIG", arguments->config, "configuration file (YAML)")->required();
    command->add_option("--engine", arguments->engine, "slurm")
        ->required()
        ->check(CLI::IsMember({"slurm"}));
    command->add_option("-o,--output", arguments->output, "folder for the results");
    command->add_option("--shards", arguments->shards, "tasks that share the tiles")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    command
        ->add_option("--sbatch", arguments->sbatch,
                     "an option for every job: --sbatch=--partition=long; may be repeated")
        ->allow_extra_args(false)
        ->take_all();
    command->add_option("--program", arguments->program,
                        "hsgm as the nodes find it (default: the path of this one)");
    command->add_flag("--dry-run", arguments->dry_run, "write the scripts, file nothing");
    add_knobs(*command, arguments->knobs);
    command->callback([arguments] { submit(*arguments); });
    return command;
}

} // namespace hsgm::pipeline
