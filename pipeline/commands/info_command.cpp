#include "pipeline/commands/info_command.h"

#include "io/gdal_session.h"
#include "matcher/cuda/device.h"
#include "matcher/matcher.h"
#include "pipeline/budget.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <tbb/info.h>
#include <tbb/version.h>

namespace hsgm::pipeline {

namespace {

void print_info()
{
    fmt::print("hsgm      {}\n", HSGM_VERSION);
    fmt::print("threads   {}\n", tbb::info::default_concurrency());
    fmt::print("memory    {} MiB, of which a run takes at most 80 % unless told otherwise\n",
               available_memory_bytes() >> 20);
    fmt::print("vectors   {}\n", matcher::vector_instructions());
    const auto devices = matcher::cuda::find_devices();
    fmt::print("devices   cpu{}\n", devices.usable.empty()
                                        ? fmt::format(" (no CUDA device: {})", devices.why_none)
                                        : "");
    for (const auto& device : devices.usable) {
        fmt::print("          cuda:{} {}, compute capability {}.{}, {} of {} MiB free\n",
                   device.number, device.name, device.capability / 10, device.capability % 10,
                   device.free_bytes >> 20, device.memory_bytes >> 20);
    }
    fmt::print("modes     hsgm, hsgm-paper, sgm, local\n");
    fmt::print("costs     census5x5, census7x7, census9x7, pairs5x5, ternary5x5, census_ad,\n"
               "          pairs_bt, birchfield_tomasi, hmi\n");
    fmt::print("libraries GDAL {}, oneTBB {}\n", io::gdal_version(), TBB_runtime_version());
}

} // namespace

CLI::App* add_info_command(CLI::App& app)
{
    CLI::App* command =
        app.add_subcommand("info", "Tell versions, processor, memory and devices");
    command->callback(print_info);
    return command;
}

} // namespace hsgm::pipeline
