#include "pipeline/commands/knobs.h"
#include "pipeline/commands/match_command.h"
#include "pipeline/commands/reporting.h"

#include "io/error.h"
#include "io/pending_file.h"
#include "pipeline/configuration.h"
#include "pipeline/stages/match_stage.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

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
Paths are relative to the configuration file. docs/configuration.md explains every key.)";

constexpr const char* kPlanHelp = R"(Examples:
  hsgm plan configs/demo.yaml
  hsgm plan city.yaml --memory 2GiB --json

Opens the inputs, reads no pixels, and tells levels, tiles, memory and disk of the run.)";

struct Arguments {
    std::string config;
    std::string output;
    bool dry_run = false;
    bool json = false;
    Knobs knobs;
};

Configuration load(const Arguments& arguments)
{
    auto document = io::ConfigDocument::load(arguments.config);
    arguments.knobs.apply(document);
    if (!arguments.output.empty()) {
        // From the command line, so relative to where the user stands.
        document.set("output.folder",
                     "'" + std::filesystem::absolute(arguments.output).string() + "'");
    }
    return read_configuration(document);
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

void run(const Arguments& arguments)
{
    const Configuration configuration = load(arguments);
    const PlannedJob planned = plan_job(configuration.job);
    if (arguments.dry_run) {
        print_plan(planned, false);
        return;
    }
    log_plan(planned);
    make_folder(configuration.folder);
    if (planned.job.satellite) {
        io::write_text_file((configuration.folder / "geometry.json").string(),
                            to_json(*planned.job.satellite->pair));
    }
    ProgressLog progress;
    const MatchSummary summary = run_job(planned, std::ref(progress));
    // Last, because until then the folder may hold the results of an earlier run.
    io::write_text_file((configuration.folder / "config.used.yaml").string(),
                        configuration.used_yaml);
    log_summary(summary, planned);
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
    command->callback([arguments] { run(*arguments); });
    return command;
}

CLI::App* add_plan_command(CLI::App& app)
{
    CLI::App* command = app.add_subcommand("plan", "Tell what a run would do and take");
    command->footer(kPlanHelp);
    const auto arguments = add_arguments(*command);
    command->add_flag("--json", arguments->json, "as JSON");
    command->callback(
        [arguments] { print_plan(plan_job(load(*arguments).job), arguments->json); });
    return command;
}

} // namespace hsgm::pipeline
