#include "pipeline/commands/bench_command.h"

#include "io/scratch_folder.h"
#include "pipeline/bench/report.h"
#include "pipeline/commands/bench_arguments.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <optional>

namespace hsgm::pipeline {

namespace {

using bench::BenchSettings;

constexpr const char* kHelp = R"(Examples:
  hsgm bench --quick                                  some seconds: is this build as fast as it was?
  hsgm bench                                          some minutes: every cost, peer and instruction set
  hsgm bench --side 4096 --disparities 128 --cost ternary5x5 --peers hh,3way
  hsgm bench --side 2048 --disparities 128,256,512 --peers hh --threads 1
  hsgm bench --instructions avx2 --peers hh --set matcher.paths=4
  hsgm bench --device cuda --cost ternary5x5 --peers none --tile-size 2048
  hsgm bench left.tif right.tif --disparity 0,127 --json > bench.json
  hsgm bench --whole --peers none                     the program from files to files, too

Times the whole match (pyramid, every level, both views' winners, left-right check, median) of
a pair in memory, beside OpenCV's StereoSGBM in the same process. Every run comes right after
one of what it is compared with; the last column is the median of those ratios.
OpenCV leaves out as many columns as there are disparities: `compared` counts only the columns
that all evaluate. Pruning searches less than is asked for: `evaluated` counts what is searched.

The scene `town` is a town on hills that fill most of the range; `towers` has roofs of up to
85 % of the range on flat ground, the hardest case for pruning. Of every list the first entry
is the base, and the others are measured one at a time against it.
Peers whose memory is not free are left out, with a line that says so. Times of a machine that
does other work mean little, ratios more. With --json, JSON goes to standard output and the
table to standard error. docs/benchmarks.md explains every figure.)";

bench::PairResult measure(const bench::BenchPair& pair, const BenchSettings& settings)
{
    const auto log = [](const std::string& step) { spdlog::info("{}", step); };
    bench::PairResult result = bench::measure_pair(pair, settings, log);
    if (settings.whole) {
        log("files to files");
        const io::ScratchFolder folder(std::filesystem::temp_directory_path());
        std::string left = settings.left;
        std::string right = settings.right;
        if (left.empty()) {
            bench::write_pair(pair, folder.path());
            left = (folder.path() / "left.tif").string();
            right = (folder.path() / "right.tif").string();
        }
        matcher::Options options = settings.options;
        options.cost = settings.costs.front();
        result.whole =
            bench::match_files(left, right, pair.asked, options, settings.threads.front(),
                               settings.repeats, folder.path());
    }
    return result;
}

// The pairs of a rendered scene, whose memory is looked at before the first is rendered.
void measure_scenes(const BenchSettings& s, std::vector<bench::PairResult>& results)
{
    for (const int side : s.sides_px) {
        for (const int disparities : s.disparities) {
            bench::check_memory({{side, side}, {side, side}, {0, disparities - 1}}, s);
        }
    }
    for (const int side : s.sides_px) {
        for (const int disparities : s.disparities) {
            spdlog::info("rendering {} x {} px, {} disparities", side, side, disparities);
            results.push_back(measure(bench::render_pair(s.scene, side, disparities), s));
        }
    }
}

void run(const BenchArguments& arguments)
{
    bench::BenchResult result;
    result.settings = bench_settings(arguments);
    const BenchSettings& s = result.settings;
    if (s.left.empty()) {
        measure_scenes(s, result.pairs);
    } else {
        result.pairs.push_back(measure(bench::read_pair(s.left, s.right, s.asked), s));
    }
    spdlog::info("inner loops");
    result.inner = bench::measure_inner_loops(s.instructions, s.repeats);
    if (arguments.json) {
        fmt::print("{}\n", bench::json(result));
    }
    fmt::print(arguments.json ? stderr : stdout, "{}", bench::table(result));
}

} // namespace

CLI::App* add_bench_command(CLI::App& app)
{
    CLI::App* command =
        app.add_subcommand("bench", "Measure speed and memory beside OpenCV's StereoSGBM");
    command->footer(kHelp);
    const auto arguments = std::make_shared<BenchArguments>();
    add_bench_options(*command, *arguments);
    command->callback([arguments] { run(*arguments); });
    return command;
}

} // namespace hsgm::pipeline
