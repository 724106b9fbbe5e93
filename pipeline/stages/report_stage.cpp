#include "pipeline/stages/report_stage.h"

#include "io/pending_file.h"
#include "pipeline/stages/report_gantt.h"
#include "pipeline/stages/run_books.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>

namespace hsgm::pipeline {

namespace {

using nlohmann::ordered_json;

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --line: #8884; --soft: #8882; --done: #3b7dd8;
  --stage: #6a9a3c; --bad: #d0483e; --dead: #9a8f86; }
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 76rem;
  padding: 0 1rem; }
h1 { font-size: 1.5rem; margin-bottom: 0; } h2 { font-size: 1.1rem; margin-top: 2.2rem; }
p.sub { margin-top: .2rem; opacity: .75; }
table { border-collapse: collapse; } td, th { padding: .2rem .9rem .2rem 0; text-align: left;
  border-bottom: 1px solid var(--line); vertical-align: top; font-variant-numeric: tabular-nums; }
td.n, th.n { text-align: right; } code { font-size: .85em; overflow-wrap: anywhere; }
.bar { background: var(--soft); width: 16rem; } .bar span { display: block; height: .8rem;
  background: var(--done); }
.gantt { width: 100%; } .gantt text { font-size: 10px; fill: currentColor; }
.gantt .tick { text-anchor: middle; opacity: .7; } .gantt .rule { stroke: var(--line); }
.gantt .cut { stroke: var(--bad); stroke-dasharray: 2 2; }
.gantt .done { fill: var(--done); } .gantt .stage { fill: var(--stage); }
.gantt .failed { fill: var(--bad); } .gantt .died { fill: var(--dead); }
img { max-width: 48%; } details { margin-top: .6rem; }
)";

ordered_json read_record(const RunLayout& layout)
{
    std::ifstream file(layout.root / "run.json");
    return file ? ordered_json::parse(file, nullptr, false) : ordered_json();
}

std::string row(const std::string& name, const std::string& value)
{
    return fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped(name), value);
}

std::string summary_section(const std::vector<Book>& books, const ordered_json& record)
{
    TileCounts all;
    for (const Book& book : books) {
        const TileCounts counts = count_tiles(book);
        all.all += counts.all;
        all.done += counts.done;
        all.failed += counts.failed;
    }
    std::string html = "<table>\n";
    html += row("state", is_assembled(books)
                             ? all.failed > 0 ? "finished, with failed tiles" : "finished"
                             : "not finished");
    html +=
        row("tiles", fmt::format("{} of {} done, {} failed", all.done, all.all, all.failed));
    if (record.contains("result")) {
        const ordered_json& result = record["result"];
        html += row("pixels",
                    fmt::format("{} of {} have a value", result["with_value"].get<long long>(),
                                result["pixels"].get<long long>()));
        html += row("completeness",
                    fmt::format("<div class='bar'><span style='width:{0:.2f}%'></span></div>"
                                "{0:.2f} %",
                                result["complete_percent"].get<double>()));
    }
    return html + "</table>\n";
}

std::string reasons_section(const ordered_json& record)
{
    if (!record.contains("result")) {
        return "";
    }
    const auto pixels = record["result"]["pixels"].get<double>();
    std::string html = "<h2>Reasons</h2>\n<table>\n<tr><th>reason</th><th class='n'>pixels</th>"
                       "<th class='n'>share</th></tr>\n";
    for (const auto& [name, count] : record["result"]["reasons"].items()) {
        html += fmt::format(
            "<tr><td>{}</td><td class='n'>{}</td><td class='n'>{:.2f} %</td></tr>\n",
            escaped(name), count.get<long long>(),
            pixels > 0 ? 100 * count.get<double>() / pixels : 0);
    }
    return html + "</table>\n";
}

std::string number_or_dash(const ordered_json& value)
{
    return value.is_number() ? fmt::format("{:.4f}", value.get<double>()) : "–";
}

std::string seams_section(const ordered_json& record)
{
    if (!record.contains("seams") || !record["seams"].is_object()) {
        return "";
    }
    std::string html =
        "<h2>Seams</h2>\n<p>Mean jump of the disparity between neighbours on two sides of a "
        "border, over the mean jump more than 4 px from every border, with a 95 % interval. 1: "
        "the borders do not show.</p>\n<table>\n<tr><th>borders of</th><th class='n'>ratio</th>"
        "<th class='n'>from</th><th class='n'>to</th><th class='n'>jump there, px</th>"
        "<th class='n'>elsewhere, px</th></tr>\n";
    for (const auto& [name, seam] : record["seams"].items()) {
        html +=
            fmt::format("<tr><td>{}s of {} px</td>", escaped(name), seam["cell_px"].get<int>());
        for (const char* key :
             {"ratio", "ratio_low", "ratio_high", "border_jump_px", "far_jump_px"}) {
            html += fmt::format("<td class='n'>{}</td>", number_or_dash(seam[key]));
        }
        html += "</tr>\n";
    }
    return html + "</table>\n";
}

std::string stages_section(const std::vector<Book>& books)
{
    std::string html = "<h2>Time</h2>\n<table>\n<tr><th>part</th><th>stage</th><th "
                       "class='n'>seconds</th><th class='n'>Mpx/s</th><th>outcome</th></tr>\n";
    const auto line = [&](const Book& book, const std::string& stage, double seconds,
                          const std::string& pace, const std::string& outcome) {
        html +=
            fmt::format("<tr><td>{}</td><td>{}</td><td class='n'>{:.2f}</td>"
                        "<td class='n'>{}</td><td>{}</td></tr>\n",
                        escaped(book.name), escaped(stage), seconds, pace, escaped(outcome));
    };
    for (const Book& book : books) {
        double tiles_s = 0;
        int tiles = 0;
        for (const ledger::AttemptRow& attempt : book.contents.attempts) {
            if (attempt.stage == "match") {
                tiles_s += attempt.seconds;
                ++tiles;
            } else {
                line(book, attempt.stage, attempt.seconds, "", attempt.outcome);
            }
        }
        if (tiles > 0) {
            line(book, fmt::format("{} tiles, all workers together", tiles), tiles_s,
                 fmt::format("{:.2f}", pixels_per_second(book) / 1e6), "");
        }
    }
    return html + "</table>\n";
}

std::string failures_section(const std::vector<Book>& books)
{
    std::string rows;
    for (const Book& book : books) {
        for (const ledger::TileRow& tile : book.contents.tiles) {
            if (tile.state == ledger::TileState::failed) {
                rows += fmt::format("<tr><td>{}</td><td>{}-{}</td><td>{}-{}</td><td "
                                    "class='n'>{}</td><td>{}</td></tr>\n",
                                    escaped(book.name), tile.rect.row, tile.rect.row_end() - 1,
                                    tile.rect.col, tile.rect.col_end() - 1, tile.attempts,
                                    escaped(tile.reason));
            }
        }
    }
    return rows.empty() ? ""
                        : "<h2>Failed tiles</h2>\n<table>\n<tr><th>part</th><th>rows</th>"
                          "<th>columns</th><th class='n'>attempts</th><th>reason</th></tr>\n" +
                              rows + "</table>\n";
}

std::string facts_section(const ordered_json& record)
{
    if (!record.contains("defines")) {
        return "";
    }
    std::string html = "<h2>What defines the result</h2>\n<table>\n";
    for (const auto& [name, value] : record["defines"].items()) {
        html += row(name, "<code>" + escaped(value.get<std::string>()) + "</code>");
    }
    html += "</table>\n<h2>Outputs</h2>\n<table>\n<tr><th>file</th><th class='n'>bytes</th>"
            "<th>SHA-256</th></tr>\n";
    for (const auto& [name, output] : record["outputs"].items()) {
        html +=
            fmt::format("<tr><td>{}</td><td class='n'>{}</td><td><code>{}</code></td></tr>\n",
                        escaped(name), output["bytes"].get<long long>(),
                        escaped(output["sha256"].get<std::string>()));
    }
    return html + "</table>\n";
}

std::string pictures(const RunLayout& layout)
{
    std::string html;
    for (const char* name : {"disparity.png", "hillshade.png"}) {
        if (std::filesystem::exists(layout.root / name)) {
            html += fmt::format("<img src='{0}' alt='{0}'>\n", name);
        }
    }
    return html;
}

} // namespace

void write_report(const RunLayout& layout)
{
    const std::vector<Book> books = read_books(layout);
    const ordered_json record = read_record(layout);
    const std::string name =
        std::filesystem::absolute(layout.root).lexically_normal().filename().string();
    const std::string gantt = gantt_svg(books);
    std::string html =
        fmt::format("<!doctype html>\n<html lang='en'><head><meta charset='utf-8'>"
                    "<title>{0}</title><style>{1}</style></head><body>\n<h1>{0}</h1>\n"
                    "<p class='sub'>hsgm {2}</p>\n",
                    escaped(name), kStyle, HSGM_VERSION);
    html += summary_section(books, record) + pictures(layout) + failures_section(books) +
            seams_section(record) + reasons_section(record) + stages_section(books);
    if (!gantt.empty()) {
        html +=
            "<h2>Tiles and workers</h2>\n<p>One lane for each worker; blue: done, red: "
            "failed, grey: the process died; green: stages. Dashed: a pause cut out.</p>\n" +
            gantt + "\n";
    }
    html += facts_section(record) + "</body></html>\n";
    io::write_text_file((layout.root / "report.html").string(), html);
}

} // namespace hsgm::pipeline
