#include "pipeline/commands/batch_command.h"

#include "io/config.h"
#include "io/error.h"
#include "io/pending_file.h"
#include "pipeline/batch/batch.h"
#include "pipeline/batch/ortho_archive.h"
#include "pipeline/error.h"
#include "pipeline/stages/raster_strips.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace hsgm::pipeline {

namespace {

constexpr const char* kHelp = R"(Examples:
  hsgm batch archive/ -c city.yaml -o results
  hsgm batch pairs.csv -c city.yaml -o results --jobs 2 --resume
  hsgm batch pairs.yaml -c city.yaml -o results --set matcher.cost=census9x7

The archive is a folder, with a folder for each pair that holds left.* and right.*, or files
NAME_left.* and NAME_right.*; a CSV file whose first row names its columns (name, left, right,
and keys of the configuration, such as matcher.disparity); or a YAML file:

  pairs:
    - {name: north, left: n/left.tif, right: n/right.tif, set: {matcher.disparity: [0, 63]}}

For geometry kind ortho the folder holds orthoimages: each is paired with the one that serves
it best, by overlap and view; how they were taken is in their metadata, or in views.csv there
(image, azimuth_deg, incidence_deg, rpc). DIR/unpaired.csv says what was left out, and why.

Each pair is a run of its own, with results in DIR/NAME and its log in DIR/NAME/logs/job.log; one
that fails does not disturb the others. DIR/summary.csv has a row for each. Exit code 5 where
a pair failed; --resume goes on with those that are not finished.)";

struct Arguments {
    std::string manifest;
    BatchOptions options;
};

// The column of messages is cut, since the table is for people; summary.csv has all of it.
void print_table(const std::vector<BatchResult>& results)
{
    std::size_t width = 4;
    for (const BatchResult& r : results) {
        width = std::max(width, r.name.size());
    }
    fmt::print("{:<{}}  {:<14} {:>9} {:>7} {:>7} {:>10} {:>7}  {}\n", "name", width, "state",
               "seconds", "tiles", "failed", "complete", "seams", "message");
    for (const BatchResult& r : results) {
        fmt::print("{:<{}}  {:<14} {:>9.1f} {:>7} {:>7} {:>10} {:>7}  {}\n", r.name, width,
                   state_of(r), r.seconds, r.tiles_done ? std::to_string(*r.tiles_done) : "",
                   r.tiles_failed ? std::to_string(*r.tiles_failed) : "",
                   r.complete_percent ? fmt::format("{:.1f} %", *r.complete_percent) : "",
                   r.seam_ratio ? fmt::format("{:.3f}", *r.seam_ratio) : "",
                   r.message.substr(0, 80));
    }
}

/// The pairs of a folder of orthoimages; nothing where the archive is something else.
std::optional<std::vector<BatchPair>> ortho_pairs(const Arguments& arguments)
{
    auto document = io::ConfigDocument::load(arguments.options.config);
    for (const std::string& setting : arguments.options.overrides) {
        document.set(setting);
    }
    io::ConfigSection geometry = document.root().section("geometry");
    if (geometry.text("kind", "") != "ortho" ||
        !std::filesystem::is_directory(arguments.manifest)) {
        return std::nullopt;
    }
    OrthoArchive archive = pair_orthos(
        arguments.manifest, geometry.optional_number("reference_height_m").value_or(0));
    for (const LeftOutImage& image : archive.left_out) {
        spdlog::warn("not paired: {}: {}", image.image, image.why);
    }
    if (archive.pairs.empty()) {
        throw io::ConfigError(
            fmt::format("{} holds no two orthoimages that make a pair", arguments.manifest));
    }
    make_output_folder(arguments.options.folder.string());
    io::write_text_file((arguments.options.folder / "unpaired.csv").string(),
                        text_of(archive.left_out));
    return std::move(archive.pairs);
}

void run(const Arguments& arguments)
{
    const auto orthos = ortho_pairs(arguments);
    const auto pairs = orthos ? *orthos : read_manifest(arguments.manifest);
    std::size_t ended = 0;
    const auto told = [&](const BatchResult& result) {
        ++ended;
        const std::string text =
            fmt::format("{} of {}: {}: {}, {:.1f} s{}{}", ended, pairs.size(), result.name,
                        state_of(result), result.seconds, result.message.empty() ? "" : ": ",
                        result.message);
        result.exit_code == 0 ? spdlog::info("{}", text) : spdlog::warn("{}", text);
    };
    const auto results = run_batch(pairs, arguments.options, told);
    print_table(results);
    const auto failed = std::count_if(results.begin(), results.end(),
                                      [](const BatchResult& r) { return r.exit_code != 0; });
    if (failed > 0) {
        throw FailedTiles(
            fmt::format("{} of {} pairs failed: see {}/summary.csv; --resume goes "
                        "on with them",
                        failed, results.size(), arguments.options.folder.string()));
    }
}

} // namespace

CLI::App* add_batch_command(CLI::App& app)
{
    CLI::App* command = app.add_subcommand("batch", "Carry out an archive of pairs");
    command->footer(kHelp);
    const auto arguments = std::make_shared<Arguments>();
    BatchOptions& o = arguments->options;
    command->add_option("ARCHIVE", arguments->manifest, "folder, CSV or YAML file")->required();
    command->add_option("-c,--config", o.config, "configuration for all pairs (YAML)")
        ->required();
    command->add_option("-o,--output", o.folder, "folder for the results")->required();
    command->add_option("--jobs", o.jobs, "runs at once, which share threads and memory")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    command->add_flag("--resume", o.resume, "go on with what is not finished");
    command->add_flag("--restart", o.restart, "throw unfinished runs away");
    command->add_option("--set", o.overrides, "override any key for all pairs")
        ->allow_extra_args(false)
        ->take_all();
    command->callback([arguments] { run(*arguments); });
    return command;
}

} // namespace hsgm::pipeline
