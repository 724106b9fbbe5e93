#include "pipeline/commands/knobs.h"
#include "pipeline/commands/match_command.h"
#include "pipeline/commands/plan_report.h"
#include "pipeline/commands/reporting.h"

#include "io/error.h"
#include "pipeline/commands/shard_option.h"
#include "pipeline/configuration.h"
#include "pipeline/error.h"
#include "pipeline/pairs/run_pairs.h"
#include "pipeline/stages/fingerprint_stage.h"
#include "pipeline/stages/match_stage.h"
#include "pipeline/stages/stored_geometry.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <map>
#include <memory>
#include <system_error>

namespace hsgm::pipeline {

namespace {

constexpr const char* kRunHelp = R"(Examples:
  hsgm run configs/demo.yaml
  hsgm run city.yaml -o result --tile-size 512 --memory 2GiB
  hsgm run city.yaml --dry-run
  hsgm run city.yaml --set matcher.cost=census9x7 --set matcher.p2=160

The least configuration of a rectified pair:
  pair: {left: left.tif, right: right.tif}
  geometry: {kind: rectified}
  matcher: {disparity: [0, 63]}
  output: {folder: result}
and of a raw satellite pair with RPCs:
  pair: {left: left.tif, right: right.tif}
  geometry: {kind: rpc}
  output: {folder: result}
and of two orthoimages, which say how they were taken, on a DEM:
  pair: {left: left.tif, right: right.tif}
  geometry: {kind: ortho, reference_dem: dem.tif}
  output: {folder: result}
Several raw images of one area become one DSM:
  images: {a: a.tif, b: b.tif, c: c.tif}
  geometry: {kind: rpc}
  output: {folder: result}
Paths are relative to the configuration file. docs/configuration.md explains every key.)";

constexpr const char* kPlanHelp = R"(Examples:
  hsgm plan configs/demo.yaml
  hsgm plan city.yaml --memory 2GiB --json
  hsgm plan city.yaml --shards 16

Opens the inputs and tells levels, tiles, memory, disk and time of the run, and with --shards what
each process of a run shared out like that does and takes. Reads no pixels, but of raw pairs,
whose geometry must be found first. The time is a guess from a short measurement on this machine, and the one
thing that differs from call to call: --no-time leaves it out.)";

struct Arguments {
    std::string config;
    std::string output;
    std::string shard;
    std::string stage = "all";
    bool resume = false;
    bool restart = false;
    bool take_over = false;
    bool dry_run = false;
    Knobs knobs;
};

struct Loaded {
    io::ConfigDocument document;
    Configuration configuration;
};

io::ConfigDocument read_document(const Arguments& arguments)
{
    auto document = io::ConfigDocument::load(arguments.config);
    arguments.knobs.apply(document);
    if (!arguments.output.empty()) {
        // From the command line, so relative to where the user stands.
        document.set("output.folder",
                     "'" + std::filesystem::absolute(arguments.output).string() + "'");
    }
    return document;
}

Loaded load(const Arguments& arguments)
{
    auto document = read_document(arguments);
    const Configuration configuration = read_configuration(document);
    return {document, configuration};
}

RunManner manner_of(const Arguments& arguments, const Loaded& loaded)
{
    static const std::map<std::string, RunStage> kStages{{"all", RunStage::all},
                                                         {"coarse", RunStage::coarse},
                                                         {"tiles", RunStage::tiles},
                                                         {"assemble", RunStage::assemble}};
    RunManner manner;
    manner.folder = loaded.configuration.folder;
    manner.stage = kStages.at(arguments.stage);
    manner.shard = shard_from(arguments.shard);
    manner.resume = arguments.resume || is_requeued();
    manner.restart = arguments.restart;
    manner.take_over = arguments.take_over;
    manner.used_yaml = loaded.configuration.used_yaml;
    manner.validate();
    return manner;
}

void make_folder(const std::filesystem::path& folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw io::StorageError(fmt::format("cannot make the output folder {}: {}",
                                           folder.string(), error.message()));
    }
}

/// Several pairs that become one DSM.
void run_several(const Arguments& arguments)
{
    if (!arguments.shard.empty() || arguments.stage != "all" || arguments.take_over) {
        throw io::ConfigError(
            "--shard, --stage and --take-over are for one pair: run each of "
            "several with its own configuration, and fuse them with hsgm fuse");
    }
    const PairList list = read_pair_list(arguments.config, arguments.knobs, arguments.output);
    if (!arguments.dry_run) {
        run_pairs(list, {arguments.resume || is_requeued(), arguments.restart, "info"});
        return;
    }
    for (const std::string& pair : list.left_out) {
        fmt::print("left out: {}\n", pair);
    }
    for (const ListedPair& pair : list.pairs) {
        fmt::print("{}\n", pair.name);
        print_plan(plan_job(pair.configuration.job), PlanReport{});
    }
}

void run(const Arguments& arguments)
{
    if (has_several_pairs(read_document(arguments))) {
        run_several(arguments);
        return;
    }
    const Loaded loaded = load(arguments);
    RunManner manner = manner_of(arguments, loaded);
    Job job = loaded.configuration.job;
    take_kept_geometry(job, manner);
    const PlannedJob planned = plan_job(job);
    if (arguments.dry_run) {
        PlanReport report;
        if (manner.shard) {
            report.shards = manner.shard->count;
        }
        print_plan(planned, report);
        return;
    }
    log_plan(planned);
    manner.settings = settings_of(loaded.document);
    make_folder(manner.folder);
    ProgressLog progress;
    const RunResult result = run_job(planned, manner, std::ref(progress));
    if (result.summary) {
        log_summary(*result.summary, planned);
    }
    if (!result.failed.empty()) {
        throw FailedTiles(failure_sentence(result) +
                          "; the results say failed_tile there, --resume tries them again");
    }
}

std::shared_ptr<Arguments> add_arguments(CLI::App& command)
{
    const auto arguments = std::make_shared<Arguments>();
    command.add_option("CONFIG", arguments->config, "configuration file (YAML)")->required();
    command.add_option("-o,--output", arguments->output, "folder for the results");
    add_knobs(command, arguments->knobs);
    return arguments;
}

} // namespace

CLI::App* add_run_command(CLI::App& app)
{
    CLI::App* command = app.add_subcommand("run", "Carry out a configuration file");
    command->footer(kRunHelp);
    const auto arguments = add_arguments(*command);
    command->add_flag("--dry-run", arguments->dry_run, "check and plan, but do nothing");
    command->add_flag("--resume", arguments->resume,
                      "go on where an earlier attempt stopped: only what is missing is done");
    command->add_flag("--restart", arguments->restart, "throw an unfinished attempt away");
    command->add_option(
        "--shard", arguments->shard,
        "only this share of the tiles: I/N, I from 0; auto: as the job array of "
        "Slurm or Kubernetes says; auto/N");
    command
        ->add_option("--stage", arguments->stage,
                     "coarse, tiles or assemble: one stage of a sharded run (default: all)")
        ->check(CLI::IsMember({"all", "coarse", "tiles", "assemble"}));
    command->add_flag(
        "--take-over", arguments->take_over,
        "the process that has the shard is known to be gone, whatever its lock says");
    command->callback([arguments] { run(*arguments); });
    return command;
}

CLI::App* add_plan_command(CLI::App& app)
{
    CLI::App* command = app.add_subcommand("plan", "Tell what a run would do and take");
    command->footer(kPlanHelp);
    const auto arguments = add_arguments(*command);
    const auto report = std::make_shared<PlanReport>();
    command->add_flag("--json", report->json, "as JSON");
    command
        ->add_option("--shards", report->shards,
                     "also what each part of a run with so many shards would do and take")
        ->check(CLI::Range(1, 100000));
    command->add_flag("--no-time{false}", report->time, "without the time that it may take");
    command->callback([arguments, report] {
        print_plan(plan_job(load(*arguments).configuration.job), *report);
    });
    return command;
}

} // namespace hsgm::pipeline
