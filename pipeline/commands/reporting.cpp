#include "pipeline/commands/reporting.h"

#include "matcher/reasons.h"
#include "pipeline/commands/plan_report.h"
#include "pipeline/run_log.h"
#include "pipeline/stages/satellite_record.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <string>

namespace hsgm::pipeline {

namespace {

double mebi(std::int64_t bytes)
{
    return static_cast<double>(bytes) / (1 << 20);
}

} // namespace

void log_plan(const PlannedJob& planned)
{
    const auto range = planned.shape.asked;
    if (planned.job.satellite) {
        const geometry::PairGeometry& pair = *planned.job.satellite->pair;
        spdlog::info("{}", describe_geometry(pair));
        for (const std::string& warning : pair.warnings) {
            spdlog::warn("{}", warning);
        }
    }
    spdlog::info(
        "{} x {} px, disparities {}..{}, mode {}, cost {}, {} levels; tiles {}; at most "
        "{:.0f} MiB",
        planned.shape.left.cols, planned.shape.left.rows, range.min, range.max,
        name(planned.job.matcher.mode), name(planned.job.matcher.cost), planned.levels.levels(),
        tile_text(planned.budget), mebi(planned.budget.estimate_bytes));
    if (!planned.devices.note.empty()) {
        spdlog::info("no CUDA device takes part: {}", planned.devices.note);
    }
    if (!planned.devices.cuda.empty()) {
        spdlog::info("matching on {}", planned.devices.text());
    }
}

void log_summary(const MatchSummary& summary, const PlannedJob& planned)
{
    const auto percent = [&summary](std::int64_t n) {
        return 100.0 * static_cast<double>(n) / static_cast<double>(summary.pixels);
    };
    std::string reasons;
    for (const auto& [bit, reason] : matcher::kReasonNames) {
        for (unsigned b = 0; b < 16; ++b) {
            if ((bit >> b & 1) != 0 && summary.with_reason[b] > 0) {
                reasons += fmt::format("{}{} {:.1f} %", reasons.empty() ? "" : ", ", reason,
                                       percent(summary.with_reason[b]));
            }
        }
    }
    spdlog::info("{}: {:.1f} % of the pixels have a value{}{}",
                 planned.job.outputs.disparity.string(), percent(summary.with_value),
                 reasons.empty() ? "" : "; ", reasons);
    if (summary.dsm) {
        const dsm::DsmGrid& grid = summary.dsm->grid;
        spdlog::info("{}: {} x {} cells of {:g}, {:.1f} % of them with a height",
                     planned.job.outputs.dsm.string(), grid.size.cols, grid.size.rows,
                     grid.cell,
                     100.0 * static_cast<double>(summary.dsm->cells_with_value) /
                         static_cast<double>(grid.size.area()));
    }
}

ProgressLog::ProgressLog()
    : start_(std::chrono::steady_clock::now()),
      terminal_(isatty(STDERR_FILENO) != 0 && !logs_json())
{
}

void ProgressLog::operator()(const TileProgress& progress)
{
    const int done = progress.done;
    const int all = progress.all;
    const int percent = static_cast<int>(100LL * done / all);
    const int step = terminal_ ? 1 : 10;
    if (percent / step == last_percent_ / step && done != all) {
        return;
    }
    last_percent_ = percent;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    const double pixels_s =
        static_cast<double>(progress.pixels_done) / std::max(elapsed.count(), 1e-6);
    const double left_s = static_cast<double>(progress.pixels_all - progress.pixels_done) /
                          std::max(pixels_s, 1.0);
    const std::string text =
        fmt::format("{} of {} tiles, {} in flight, {:.2f} Mpx/s, {:.0f} s left{}", done, all,
                    progress.in_flight, pixels_s / 1e6, done == all ? 0.0 : left_s,
                    progress.failed > 0 ? fmt::format(", {} failed", progress.failed) : "");
    if (!terminal_) {
        spdlog::info("{}", text);
        return;
    }
    const std::string bar(static_cast<std::size_t>(percent / 4), '#');
    fmt::print(stderr, "\r[{:<25}] {:3} %  {}   {}", bar, percent, text,
               done == all ? "\n" : "");
}

} // namespace hsgm::pipeline
