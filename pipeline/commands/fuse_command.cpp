#include "pipeline/commands/fuse_command.h"

#include "io/byte_size.h"
#include "pipeline/budget.h"
#include "pipeline/pairs/fuse_runs.h"

#include <CLI/CLI.hpp>

#include <memory>

namespace hsgm::pipeline {

namespace {

constexpr const char* kHelp = R"(Examples:
  hsgm fuse result/pairs/* -o fused
  hsgm fuse monday tuesday -o both --resume

Each folder holds a finished run of a raw pair (geometry kind rpc); all must have the same
dsm.gsd_m, dsm.crs and dsm.vertical. Their surfaces are laid on each other, then each cell takes
the weighted median of those that agree. `hsgm run` with `images` runs the pairs as well.)";

struct Arguments {
    FuseRequest request;
    std::string memory = "80%";
    bool no_hillshade = false;
};

void run(Arguments arguments)
{
    FuseRequest& request = arguments.request;
    request.memory_bytes = io::parse_byte_amount(arguments.memory).of(available_memory_bytes());
    request.outputs = fused_outputs(request.folder, !arguments.no_hillshade, false);
    fuse_runs(request);
}

} // namespace

CLI::App* add_fuse_command(CLI::App& app)
{
    CLI::App* command = app.add_subcommand("fuse", "Make one DSM of several finished pairs");
    command->footer(kHelp);
    const auto arguments = std::make_shared<Arguments>();
    FuseRequest& request = arguments->request;
    command->add_option("RUNS", request.runs, "folders of finished runs")->required();
    command->add_option("-o,--output", request.folder, "folder for the result")->required();
    command
        ->add_option("--threads", request.threads, "threads to use (default: all processors)")
        ->check(CLI::Range(1, 1024));
    command->add_option("--memory", arguments->memory, "memory to stay under: 8GiB, 80%")
        ->capture_default_str();
    command->add_flag("--no-hillshade", arguments->no_hillshade, "write no hillshade.tif");
    command->add_flag("--resume", request.resume,
                      "do nothing where the same runs were fused already");
    command->callback([arguments] { run(*arguments); });
    return command;
}

} // namespace hsgm::pipeline
