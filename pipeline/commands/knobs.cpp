#include "pipeline/commands/knobs.h"

#include <CLI/CLI.hpp>

namespace hsgm::pipeline {

void Knobs::apply(io::ConfigDocument& document) const
{
    const auto set = [&document](const char* key, const std::string& value) {
        if (!value.empty()) {
            document.set(key, value);
        }
    };
    set("matcher.profile", profile);
    set("run.tile_size", tile_size);
    set("run.threads", threads);
    set("run.memory", memory);
    set("run.device", device);
    for (const std::string& assignment : overrides) {
        document.set(assignment);
    }
}

void add_knobs(CLI::App& command, Knobs& knobs)
{
    command.add_option("--profile", knobs.profile,
                       "defaults for a kind of scene: satellite, aerial or close (default "
                       "satellite)");
    command.add_option("--tile-size", knobs.tile_size,
                       "side of a tile in px, 0 = untiled (default: fits the memory)");
    command.add_option("--threads", knobs.threads, "threads to use (default: all processors)");
    command.add_option("--memory", knobs.memory,
                       "memory to stay under: 8GiB, 512MiB, 80% (default 80%)");
    command.add_option("--device", knobs.device, "auto, cpu, cuda or cuda:N (default auto)");
    // One value each, as written: the default would take brackets for CLI11's own lists.
    command.add_option("--set", knobs.overrides, "override any key: --set matcher.cost=hmi")
        ->allow_extra_args(false)
        ->take_all();
}

} // namespace hsgm::pipeline
