#include "pipeline/bench/report.h"

#include <fmt/format.h>
#include <tbb/info.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace hsgm::bench {

namespace {

using Text = std::back_insert_iterator<std::string>;

constexpr double kMillion = 1e6;
constexpr const char* kRow = "{:<34} {:>7} {:>8} {:>8} {:>8} {:>7} {:>9} {:>6} {:>6} {:>9}\n";

double mebi(std::int64_t bytes)
{
    return static_cast<double>(bytes) / (1 << 20);
}

std::string processor()
{
    std::ifstream table("/proc/cpuinfo");
    for (std::string line; std::getline(table, line);) {
        if (line.starts_with("model name")) {
            return line.substr(line.find(':') + 2);
        }
    }
    return "unknown processor";
}

void print_row(Text out, const Measured& m, const PairResult& pair)
{
    const double seconds = m.median_s();
    const auto rate = [seconds](std::int64_t cells) {
        return fmt::format("{:.0f}", static_cast<double>(cells) / seconds / kMillion);
    };
    const std::string memory = m.memory ? fmt::format("{:.0f}", mebi(m.memory->added)) : "-";
    const std::string bad = m.bad_percent ? fmt::format("{:.2f}", *m.bad_percent) : "-";
    fmt::format_to(out, kRow, m.contender.title, m.contender.threads,
                   fmt::format("{:.3f}", seconds), fmt::format("{:.3f}", median(m.cpu_seconds)),
                   rate(pair.compared_cells()), rate(pair.nominal_cells()),
                   rate(pair.evaluated_cells(m)), memory, bad,
                   fmt::format("{:.2f}", m.time_over_base()));
}

void print_work(Text out, const PairResult& pair)
{
    const Measured& base = pair.measured.front();
    const StageSeconds& s = base.stages;
    const double all = s.pyramid + s.table + s.coarse + s.windows + s.second;
    const auto share = [all](double seconds) { return 100 * seconds / all; };
    fmt::format_to(
        out, "The first went through {:.0f} % of the nominal cells, in {} windows.\n",
        100 * static_cast<double>(base.work.cells) / static_cast<double>(pair.nominal_cells()),
        base.work.windows);
    fmt::format_to(out, "Its time: pyramid {:.0f} %, ", share(s.pyramid));
    if (s.table > 0.005 * all) {
        fmt::format_to(out, "table {:.0f} %, ", share(s.table));
    }
    fmt::format_to(out, "coarsest level {:.0f} %, windows {:.0f} %, second pass {:.0f} %.\n",
                   share(s.coarse), share(s.windows), share(s.second));
}

void print_scaling(Text out, const PairResult& pair)
{
    const int threads = pair.measured.front().contender.threads;
    for (const Measured& m : pair.measured) {
        if (!m.contender.peer && m.contender.threads != threads) {
            fmt::format_to(out, "{} threads: {:.2f} times as fast as {}.\n",
                           m.contender.threads, 1 / m.time_over_base(), threads);
        }
    }
}

// Of a match on a device, most is still the processor's work.
void print_devices(Text out, const PairResult& pair)
{
    for (const Measured& m : pair.measured) {
        if (m.contender.device) {
            fmt::format_to(
                out, "{}: {}, windows alone {:.3f} s, {:.0f} million nominal a second.\n",
                m.contender.title, m.contender.device->name, m.stages.windows,
                static_cast<double>(pair.nominal_cells()) / m.stages.windows / kMillion);
        }
    }
}

void print_whole(Text out, const FileMatch& whole)
{
    fmt::format_to(out,
                   "Files to files, tiles of {} px, {} thread{}: {:.3f} s, {} MiB on top of "
                   "this process.\n",
                   whole.tile_size_px, whole.threads, whole.threads == 1 ? "" : "s",
                   median(whole.seconds),
                   whole.memory ? fmt::format("{:.0f}", mebi(whole.memory->added)) : "-");
}

void print_pair(Text out, const PairResult& pair)
{
    const auto& shape = pair.shape;
    fmt::format_to(out,
                   "\n{}: {} x {} px, disparities {}..{}; {} spans {:.0f} % of them ({:.1f} to "
                   "{:.1f} px)\n",
                   pair.source, shape.left.cols, shape.left.rows, shape.asked.min,
                   shape.asked.max, pair.span_of_truth ? "the content" : "what was found",
                   pair.span.percent, pair.span.low_px, pair.span.high_px);
    fmt::format_to(out, kRow, "", "threads", "seconds", "CPU s", "compared", "nominal",
                   "evaluated", "MiB", "bad %", "time/base");
    for (const Measured& m : pair.measured) {
        print_row(out, m, pair);
    }
    for (const LeftOut& l : pair.left_out) {
        fmt::format_to(out, "{:<34} {:>7} left out: {}\n", l.contender.title,
                       l.contender.threads, l.why);
    }
    print_work(out, pair);
    print_scaling(out, pair);
    print_devices(out, pair);
    if (pair.whole) {
        print_whole(out, *pair.whole);
    }
}

void print_legend(Text out, const BenchResult& result)
{
    fmt::format_to(out, R"(
seconds    median of {} rounds, of the whole match; CPU s: computing time of all threads
compared   million px x disparities a second, counting only the columns that all evaluate
nominal    the same of all columns, searched or not
evaluated  the same of what was searched, halos and coarser levels included
MiB        peak of resident memory above the images, measured in this process (VmHWM)
bad %      off by more than 1 px or without a value, of the pixels in both images; compared columns
time/base  median ratio to the base, run right before: peers to hsgm on as many threads,
           everything else to the first row
)",
                   result.settings.repeats);
}

} // namespace

std::string machine()
{
    return fmt::format("{}, {} threads, {}, OpenCV {}", processor(),
                       tbb::info::default_concurrency(), matcher::vector_instructions(),
                       peer_version());
}

std::string table(const BenchResult& result)
{
    std::string text;
    const Text out(text);
    fmt::format_to(out, "{}\n", machine());
    if (!result.inner.empty()) {
        fmt::format_to(out, "\nInner loops in the caches, one thread, million px x disparities "
                            "a second\n(census5x5, 8 paths, winners of both views, 128 "
                            "disparities)\n");
        for (const InnerRate& rate : result.inner) {
            fmt::format_to(out, "{:<8} path costs of {:>2} bits {:>9.0f}\n",
                           rate.instructions ? name(*rate.instructions) : "auto",
                           rate.path_bits, rate.cells_per_s / kMillion);
        }
    }
    for (const PairResult& pair : result.pairs) {
        print_pair(out, pair);
    }
    print_legend(out, result);
    return text;
}

} // namespace hsgm::bench
