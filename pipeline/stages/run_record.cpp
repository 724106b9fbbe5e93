#include "pipeline/stages/run_record.h"

#include "matcher/reasons.h"
#include "pipeline/ledger/checksum.h"
#include "pipeline/stages/evaluate_stage.h"
#include "pipeline/stages/satellite_record.h"
#include "pipeline/stages/tile_stage.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <ctime>
#include <filesystem>

namespace hsgm::pipeline {

namespace {

using ledger::TileState;
using nlohmann::ordered_json;

std::string utc(double seconds)
{
    const auto whole = static_cast<std::time_t>(seconds);
    std::tm parts{};
    ::gmtime_r(&whole, &parts);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", parts.tm_year + 1900,
                       parts.tm_mon + 1, parts.tm_mday, parts.tm_hour, parts.tm_min,
                       parts.tm_sec);
}

ordered_json place_of(const tiling::Rect& rect)
{
    return {{"row", rect.row}, {"col", rect.col}, {"rows", rect.rows}, {"cols", rect.cols}};
}

ordered_json tiles_json(const std::vector<Book>& books)
{
    ordered_json json{{"done", 0}, {"failed", 0}, {"attempts", 0}, {"died", 0}};
    ordered_json failed = ordered_json::array();
    int done = 0;
    int attempts = 0;
    int deaths = 0;
    for (const Book& book : books) {
        for (const ledger::TileRow& row : book.contents.tiles) {
            if (row.stage != kMatchStage) {
                continue;
            }
            done += row.state == TileState::done;
            attempts += row.attempts;
            deaths += row.deaths;
            if (row.state == TileState::failed) {
                ordered_json tile = place_of(row.rect);
                tile["reason"] = row.reason;
                failed.push_back(tile);
            }
        }
    }
    json["done"] = done;
    json["failed"] = failed.size();
    json["attempts"] = attempts;
    json["died"] = deaths;
    json["failed_tiles"] = failed;
    return json;
}

// Stages over the whole image, as often as they were tried; of the tiles, what all took
// together.
ordered_json stages_json(const std::vector<Book>& books)
{
    ordered_json stages = ordered_json::array();
    for (const Book& book : books) {
        double tiles_s = 0;
        for (const ledger::AttemptRow& attempt : book.contents.attempts) {
            if (attempt.stage == kMatchStage) {
                tiles_s += attempt.seconds;
                continue;
            }
            stages.push_back({{"part", book.name},
                              {"stage", attempt.stage},
                              {"started", utc(attempt.started_s)},
                              {"seconds", attempt.seconds},
                              {"outcome", attempt.outcome}});
        }
        if (book.shard) {
            stages.push_back({{"part", book.name},
                              {"stage", kMatchStage},
                              {"worker_seconds", tiles_s},
                              {"pixels_per_second", std::round(pixels_per_second(book))}});
        }
    }
    return stages;
}

ordered_json processes_json(const std::vector<Book>& books)
{
    ordered_json processes = ordered_json::array();
    for (const Book& book : books) {
        for (const ledger::Owner& owner : book.contents.owners) {
            processes.push_back({{"part", book.name},
                                 {"token", owner.token},
                                 {"host", owner.host},
                                 {"pid", owner.pid},
                                 {"job", owner.job},
                                 {"program", owner.program},
                                 {"started", utc(owner.started_s)}});
        }
    }
    return processes;
}

double percent(std::int64_t part, std::int64_t whole)
{
    return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

ordered_json summary_json(const MatchSummary& summary)
{
    ordered_json reasons;
    for (const auto& [bit, name] : matcher::kReasonNames) {
        const auto place = static_cast<std::size_t>(std::countr_zero(unsigned{bit}));
        reasons[std::string(name)] = summary.with_reason[place];
    }
    return {{"pixels", summary.pixels},
            {"with_value", summary.with_value},
            {"complete_percent", percent(summary.with_value, summary.pixels)},
            {"reasons", reasons}};
}

// Jumps of the written disparities at the borders of windows and tiles.
ordered_json seams_json(const PlannedJob& planned)
{
    DisparityInputs inputs;
    inputs.test = planned.job.outputs.disparity.string();
    std::vector<std::pair<std::string, int>> grids{{"window", planned.job.matcher.window_px}};
    if (planned.budget.tile_size_px > 1) {
        grids.emplace_back("tile", planned.budget.tile_size_px);
    }
    std::vector<int> cells_px;
    for (const auto& grid : grids) {
        cells_px.push_back(grid.second);
    }
    const auto scores = score_seams(inputs, cells_px);
    ordered_json json;
    for (std::size_t i = 0; i < grids.size(); ++i) {
        const evaluate::SeamScore& score = scores[i];
        json[grids[i].first] = {{"cell_px", cells_px[i]},
                                {"ratio", score.ratio},
                                {"ratio_low", score.ratio_low},
                                {"ratio_high", score.ratio_high},
                                {"border_jump_px", score.border_jump_px},
                                {"far_jump_px", score.far_jump_px},
                                {"border_pairs", score.border_pairs}};
    }
    return json;
}

ordered_json outputs_json(const OutputPaths& o)
{
    ordered_json json;
    for (const auto& path : o.files()) {
        json[path.filename().string()] = {{"bytes", std::filesystem::file_size(path)},
                                          {"sha256", ledger::sha256_of_file(path)}};
    }
    return json;
}

ordered_json manner_json(const PlannedJob& planned)
{
    const Budget& budget = planned.budget;
    return {{"tile_size_px", budget.tile_size_px},
            {"threads", budget.threads},
            {"tiles_in_flight", budget.tiles_in_flight},
            {"memory_allowed_bytes", budget.memory_bytes},
            {"memory_estimate_bytes", budget.estimate_bytes}};
}

} // namespace

ordered_json run_record(const PlannedJob& planned, const RunLayout& layout,
                        const MatchSummary& summary, const ledger::Facts& fingerprint,
                        const OwnedLedger& book)
{
    const tiling::Rect whole = rect_of(planned.shape.left);
    ordered_json seams;
    ordered_json outputs;
    book.record("seam figure", whole, [&] { seams = seams_json(planned); });
    book.record("checksums", whole, [&] { outputs = outputs_json(planned.job.outputs); });
    const std::vector<Book> books = read_books(layout);
    ordered_json record;
    record["program"] = "hsgm " HSGM_VERSION;
    record["defines"] = fingerprint;
    if (planned.job.satellite) {
        record["geometry"] = geometry_json(*planned.job.satellite->pair);
    }
    record["result"] = summary_json(summary);
    if (summary.dsm) {
        record["dsm"] = dsm_json(*summary.dsm);
    }
    record["seams"] = seams;
    record["tiles"] = tiles_json(books);
    record["stages"] = stages_json(books);
    record["manner"] = manner_json(planned);
    record["processes"] = processes_json(books);
    record["outputs"] = outputs;
    return record;
}

} // namespace hsgm::pipeline
