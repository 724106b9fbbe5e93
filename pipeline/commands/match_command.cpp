#include "pipeline/commands/match_command.h"

#include "io/config.h"
#include "pipeline/commands/knobs.h"
#include "pipeline/commands/range_argument.h"
#include "pipeline/commands/reporting.h"
#include "pipeline/configuration.h"
#include "pipeline/error.h"
#include "pipeline/stages/match_stage.h"

#include <CLI/CLI.hpp>

#include <memory>

namespace hsgm::pipeline {

namespace {

constexpr const char* kHelp = R"(Examples:
  hsgm match left.tif right.tif -o disparity.tif --disparity 0,63
  hsgm match left.tif right.tif -o d.tif --disparity=-64,64 --set matcher.cost=census9x7
  hsgm match left.tif right.tif -o d.tif --disparity 0,255 --memory 2GiB --tile-size 512

The pair must be rectified: a pixel (row, x) of the left image lies at (row, x - d) in the right
one. Disparities d run from MIN to MAX, both inclusive, and may be negative. Beside
disparity.tif (float32, nodata -32768) it writes disparity.confidence.tif (0..255) and
disparity.reasons.tif (why a pixel has no value, as bits).

Any key of the configuration's `matcher` and `run` sections can be set with --set; the result
is the same for every tile size, thread count and memory.)";

struct Arguments {
    std::string left;
    std::string right;
    std::string output;
    std::string disparity;
    Knobs knobs;
};

OutputPaths output_paths(const std::string& output)
{
    const std::filesystem::path path = output;
    const auto sibling = [&path](const char* what) {
        return path.parent_path() /
               (path.stem().string() + "." + what + path.extension().string());
    };
    OutputPaths outputs;
    outputs.disparity = path;
    outputs.confidence = sibling("confidence");
    outputs.reasons = sibling("reasons");
    return outputs;
}

void run(const Arguments& arguments)
{
    auto document = io::ConfigDocument::empty("command line");
    arguments.knobs.apply(document);
    Job job = read_knobs(document);
    document.refuse_unknown();
    job.left.path = arguments.left;
    job.right.path = arguments.right;
    job.disparity = parse_range(arguments.disparity);
    job.outputs = output_paths(arguments.output);
    const PlannedJob planned = plan_job(job);
    log_plan(planned);
    ProgressLog progress;
    const RunResult result = run_job(planned, RunManner{}, std::ref(progress));
    log_summary(result.summary.value(), planned);
    if (!result.failed.empty()) {
        throw FailedTiles(failure_sentence(result));
    }
}

} // namespace

CLI::App* add_match_command(CLI::App& app)
{
    CLI::App* command = app.add_subcommand("match", "Match a rectified pair");
    command->footer(kHelp);
    const auto arguments = std::make_shared<Arguments>();
    command->add_option("LEFT", arguments->left, "left image, any raster that GDAL reads")
        ->required();
    command->add_option("RIGHT", arguments->right, "right image, of equal height")->required();
    command->add_option("-o,--output", arguments->output, "disparity raster to write (GeoTIFF)")
        ->required();
    command->add_option("--disparity", arguments->disparity, "range to search: MIN,MAX in px")
        ->required()
        ->allow_extra_args(false);
    add_knobs(*command, arguments->knobs);
    command->callback([arguments] { run(*arguments); });
    return command;
}

} // namespace hsgm::pipeline
