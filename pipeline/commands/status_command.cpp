#include "pipeline/commands/status_command.h"

#include "io/pending_file.h"
#include "pipeline/stages/report_stage.h"
#include "pipeline/stages/run_books.h"
#include "pipeline/stages/stage_progress.h"
#include "pipeline/stages/tile_stage.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

namespace hsgm::pipeline {

namespace {

using nlohmann::ordered_json;

constexpr const char* kStatusHelp = R"(Examples:
  hsgm status results
  hsgm status results --json

Reads the ledgers in DIR/ledger, also while a run is at work there, on this machine or
another. Of a batch, whose runs lie in folders of DIR, a line for each. Exit code 0 whatever the
state is; --json tells it to scripts.)";

constexpr const char* kReportHelp = R"(Examples:
  hsgm report results

Writes DIR/report.html anew, as a finished run does by itself: completeness, seam figure, time
of each stage, and who matched which tile when.)";

struct Totals {
    TileCounts tiles;
    double pixels_per_second = 0;
    int at_work = 0;
};

Totals totals_of(const std::vector<Book>& books)
{
    Totals totals;
    for (const Book& book : books) {
        const TileCounts counts = count_tiles(book);
        totals.tiles.all += counts.all;
        totals.tiles.done += counts.done;
        totals.tiles.failed += counts.failed;
        totals.tiles.running += book.at_work ? counts.running : 0;
        totals.tiles.pixels_all += counts.pixels_all;
        totals.tiles.pixels_done += counts.pixels_done;
        totals.at_work += book.at_work;
        totals.pixels_per_second += book.at_work ? pixels_per_second(book) : 0;
    }
    return totals;
}

std::string state_of(const std::vector<Book>& books, const Totals& totals)
{
    if (totals.at_work > 0) {
        return "at work";
    }
    if (is_assembled(books)) {
        return totals.tiles.failed == 0 ? "finished" : "finished with failed tiles";
    }
    return "stopped";
}

// Seconds for the tiles that are missing, at the pace of those at work; nothing: unknown.
std::optional<double> seconds_left(const Totals& totals)
{
    if (totals.pixels_per_second <= 0) {
        return std::nullopt;
    }
    return static_cast<double>(totals.tiles.pixels_all - totals.tiles.pixels_done) /
           totals.pixels_per_second;
}

// The stage that a book's owner is in, and what went wrong last.
struct StageNow {
    std::string name;
    double seconds = 0; ///< since it began, by the clocks of two machines perhaps
};

StageNow now_in(const Book& book)
{
    const double now_s =
        std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch())
            .count();
    StageNow now;
    for (const ledger::TileRow& row : book.contents.tiles) {
        if (row.state == ledger::TileState::running && book.at_work) {
            now = {row.stage, std::max(now_s - row.started_s, 0.0)};
        }
    }
    return now;
}

ordered_json book_json(const Book& book)
{
    const StageNow now = now_in(book);
    ordered_json json{{"name", book.name},
                      {"at_work", book.at_work},
                      {"process", book.holder},
                      {"stage", now.name},
                      {"stage_seconds", std::round(now.seconds)}};
    if (book.shard) {
        const TileCounts counts = count_tiles(book);
        json["tiles"] = {{"all", counts.all},
                         {"done", counts.done},
                         {"failed", counts.failed},
                         {"running", counts.running}};
        json["pixels_per_second"] = std::round(pixels_per_second(book));
    }
    return json;
}

ordered_json failures_json(const std::vector<Book>& books)
{
    ordered_json list = ordered_json::array();
    for (const Book& book : books) {
        for (const ledger::TileRow& row : book.contents.tiles) {
            if (row.state == ledger::TileState::failed) {
                list.push_back({{"row", row.rect.row},
                                {"col", row.rect.col},
                                {"rows", row.rect.rows},
                                {"cols", row.rect.cols},
                                {"attempts", row.attempts},
                                {"reason", row.reason}});
            }
        }
    }
    return list;
}

ordered_json status_json(const std::vector<Book>& books)
{
    const Totals totals = totals_of(books);
    ordered_json parts = ordered_json::array();
    for (const Book& book : books) {
        parts.push_back(book_json(book));
    }
    ordered_json json{{"state", state_of(books, totals)},
                      {"tiles",
                       {{"all", totals.tiles.all},
                        {"done", totals.tiles.done},
                        {"failed", totals.tiles.failed},
                        {"running", totals.tiles.running}}},
                      {"pixels_per_second", std::round(totals.pixels_per_second)}};
    const auto left_s = seconds_left(totals);
    json["seconds_left"] = left_s ? ordered_json(std::round(*left_s)) : ordered_json(nullptr);
    json["parts"] = parts;
    json["failed_tiles"] = failures_json(books);
    return json;
}

void print_status(const ordered_json& status)
{
    const auto number = [](const ordered_json& value) { return value.get<long long>(); };
    fmt::print("state     {}\n", status["state"].get<std::string>());
    const ordered_json& tiles = status["tiles"];
    fmt::print("tiles     {} of {} done, {} at work, {} failed\n", number(tiles["done"]),
               number(tiles["all"]), number(tiles["running"]), number(tiles["failed"]));
    if (number(status["pixels_per_second"]) > 0) {
        fmt::print("pace      {:.2f} Mpx/s, {} s left for the tiles\n",
                   status["pixels_per_second"].get<double>() / 1e6,
                   number(status["seconds_left"]));
    }
    for (const ordered_json& part : status["parts"]) {
        std::string line = fmt::format("{:<9} {}", part["name"].get<std::string>(),
                                       part["at_work"].get<bool>() ? "at work" : "idle");
        if (part.contains("tiles")) {
            line += fmt::format(", {} of {} tiles", number(part["tiles"]["done"]),
                                number(part["tiles"]["all"]));
        }
        if (part["at_work"].get<bool>()) {
            const std::string stage = part["stage"].get<std::string>();
            line += stage.empty() || stage == kMatchStage
                        ? fmt::format(" ({})", part["process"].get<std::string>())
                        : fmt::format(", {} for {} s ({})", words_of_stage(stage),
                                      number(part["stage_seconds"]),
                                      part["process"].get<std::string>());
        }
        fmt::print("{}\n", line);
    }
    for (const ordered_json& tile : status["failed_tiles"]) {
        fmt::print("failed    rows {}-{}, columns {}-{}: {}\n", number(tile["row"]),
                   number(tile["row"]) + number(tile["rows"]) - 1, number(tile["col"]),
                   number(tile["col"]) + number(tile["cols"]) - 1,
                   tile["reason"].get<std::string>());
    }
}

// The runs of a batch: folders of this one that have ledgers, by name.
std::vector<std::filesystem::path> runs_below(const std::filesystem::path& folder)
{
    std::vector<std::filesystem::path> runs;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
        if (entry.is_directory() && !RunLayout{entry.path()}.all_ledgers().empty()) {
            runs.push_back(entry.path());
        }
    }
    std::sort(runs.begin(), runs.end());
    return runs;
}

void tell_of_batch(const std::vector<std::filesystem::path>& runs, bool json)
{
    ordered_json list = ordered_json::array();
    for (const auto& run : runs) {
        ordered_json status = status_json(read_books({run}));
        status["run"] = run.filename().string();
        if (!json) {
            const ordered_json& tiles = status["tiles"];
            fmt::print("{:<20} {:<9} {:>6} of {} tiles, {} failed{}\n",
                       status["run"].get<std::string>(), status["state"].get<std::string>(),
                       tiles["done"].get<int>(), tiles["all"].get<int>(),
                       tiles["failed"].get<int>(),
                       status["seconds_left"].is_null()
                           ? ""
                           : fmt::format(", {:.0f} s left for the tiles",
                                         status["seconds_left"].get<double>()));
        }
        list.push_back(std::move(status));
    }
    if (json) {
        fmt::print("{}\n", ordered_json{{"runs", list}}.dump(2));
    }
}

} // namespace

CLI::App* add_status_command(CLI::App& app)
{
    struct Arguments {
        std::string folder;
        bool json = false;
    };
    CLI::App* command = app.add_subcommand("status", "Tell how far a run is");
    command->footer(kStatusHelp);
    const auto arguments = std::make_shared<Arguments>();
    command->add_option("DIR", arguments->folder, "output folder of a run")->required();
    command->add_flag("--json", arguments->json, "as JSON");
    command->callback([arguments] {
        const RunLayout layout{arguments->folder};
        const auto runs = runs_below(layout.root);
        if (layout.all_ledgers().empty() && !runs.empty()) {
            tell_of_batch(runs, arguments->json);
            return;
        }
        const auto status = status_json(read_books(layout));
        if (arguments->json) {
            fmt::print("{}\n", status.dump(2));
        } else {
            print_status(status);
        }
    });
    return command;
}

CLI::App* add_report_command(CLI::App& app)
{
    CLI::App* command = app.add_subcommand("report", "Write the report of a run");
    command->footer(kReportHelp);
    const auto folder = std::make_shared<std::string>();
    command->add_option("DIR", *folder, "output folder of a run")->required();
    command->callback([folder] {
        write_report({*folder});
        fmt::print("{}/report.html\n", *folder);
    });
    return command;
}

} // namespace hsgm::pipeline
