#include "pipeline/stages/report_gantt.h"

#include "pipeline/stages/tile_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace hsgm::pipeline {

namespace {

constexpr double kWidth = 1000; // of the time axis, in the drawing's units
constexpr double kLabel = 190;
constexpr double kLane = 18;
constexpr double kLongestPause_s = 10;

struct Bar {
    double from_s = 0;
    double to_s = 0;
    std::string kind; ///< class of the drawing: done, failed, died, stage
    std::string title;
};
using Lanes = std::map<std::string, std::vector<Bar>>;

Lanes lanes_of(const std::vector<Book>& books)
{
    Lanes lanes;
    for (const Book& book : books) {
        for (const ledger::AttemptRow& a : book.contents.attempts) {
            const bool tile = a.stage == kMatchStage;
            const std::string lane = tile ? book.name + " " + a.worker : book.name + " stages";
            const std::string what =
                tile ? fmt::format("rows {}-{}, columns {}-{}", a.rect.row,
                                   a.rect.row_end() - 1, a.rect.col, a.rect.col_end() - 1)
                     : a.stage;
            lanes[lane].push_back(
                {a.started_s, a.started_s + a.seconds,
                 a.outcome == "done" && !tile ? "stage" : a.outcome,
                 fmt::format("{}: {}, {:.2f} s{}{}", what, a.outcome, a.seconds,
                             a.reason.empty() ? "" : ", ", a.reason)});
        }
    }
    return lanes;
}

/// Time without its long pauses.
class Axis {
public:
    explicit Axis(const Lanes& lanes)
    {
        std::vector<std::pair<double, double>> busy;
        for (const auto& [name, bars] : lanes) {
            for (const Bar& bar : bars) {
                busy.emplace_back(bar.from_s, bar.to_s);
            }
        }
        std::sort(busy.begin(), busy.end());
        for (const auto& [from, to] : busy) {
            if (spans_.empty() || from > spans_.back().to + kLongestPause_s) {
                const double before =
                    spans_.empty() ? 0 : spans_.back().before + spans_.back().length() + 1;
                spans_.push_back({from, to, before});
            }
            spans_.back().to = std::max(spans_.back().to, to);
        }
    }
    double length_s() const
    {
        return spans_.empty() ? 0 : spans_.back().before + spans_.back().length();
    }
    double at(double time_s) const
    {
        double place = 0;
        for (const Span& span : spans_) {
            if (time_s >= span.from) {
                place = span.before + std::min(time_s - span.from, span.length());
            }
        }
        return place;
    }
    /// Where pauses were cut out.
    std::vector<double> cuts() const
    {
        std::vector<double> places;
        for (std::size_t i = 1; i < spans_.size(); ++i) {
            places.push_back(spans_[i].before - 0.5);
        }
        return places;
    }

private:
    struct Span {
        double from = 0;
        double to = 0;
        double before = 0; ///< seconds drawn left of it
        double length() const { return to - from; }
    };
    std::vector<Span> spans_;
};

// Bars of the same kind that would touch are one, so that the drawing stays small.
std::vector<Bar> joined(std::vector<Bar> bars, double least_s)
{
    std::sort(bars.begin(), bars.end(),
              [](const Bar& a, const Bar& b) { return a.from_s < b.from_s; });
    std::vector<Bar> result;
    for (Bar& bar : bars) {
        const bool small = bar.to_s - bar.from_s < 3 * least_s;
        if (!result.empty() && small && result.back().kind == bar.kind &&
            bar.from_s - result.back().to_s < least_s) {
            result.back().to_s = std::max(result.back().to_s, bar.to_s);
            result.back().title = "several tiles: " + bar.kind;
        } else {
            result.push_back(std::move(bar));
        }
    }
    return result;
}

std::string ruler(const Axis& axis, double height)
{
    const double length = std::max(axis.length_s(), 1e-3);
    const double rough = length / 8;
    double step = std::pow(10, std::floor(std::log10(rough)));
    for (const double factor : {5.0, 2.0, 1.0}) {
        if (step * factor >= rough / 1.5) {
            step *= factor;
            break;
        }
    }
    std::string svg;
    for (double t = 0; t <= length; t += step) {
        const double x = kLabel + t / length * kWidth;
        svg += fmt::format("<line x1='{0:.1f}' y1='0' x2='{0:.1f}' y2='{1:.0f}' class='rule'/>"
                           "<text x='{0:.1f}' y='{2:.0f}' class='tick'>{3:g} s</text>",
                           x, height, height + 14, t);
    }
    for (const double cut : axis.cuts()) {
        svg += fmt::format("<line x1='{0:.1f}' y1='0' x2='{0:.1f}' y2='{1:.0f}' class='cut'/>",
                           kLabel + cut / length * kWidth, height);
    }
    return svg;
}

} // namespace

std::string escaped(const std::string& text)
{
    std::string result;
    for (const char c : text) {
        switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        case '\'':
            result += "&#39;";
            break;
        default:
            result += c;
        }
    }
    return result;
}

std::string gantt_svg(const std::vector<Book>& books)
{
    const Lanes lanes = lanes_of(books);
    if (lanes.empty()) {
        return "";
    }
    const Axis axis(lanes);
    const double length = std::max(axis.length_s(), 1e-3);
    const double height = kLane * static_cast<double>(lanes.size());
    std::string svg = fmt::format("<svg class='gantt' viewBox='0 0 {:.0f} {:.0f}' role='img' "
                                  "aria-label='Tiles and workers over time'>",
                                  kLabel + kWidth + 30, height + 20) +
                      ruler(axis, height);
    double y = 0;
    for (const auto& [name, bars] : lanes) {
        svg += fmt::format("<text x='0' y='{:.1f}' class='lane'>{}</text>", y + kLane - 5,
                           escaped(name));
        for (const Bar& bar : joined(bars, length / kWidth)) {
            const double x = axis.at(bar.from_s) / length * kWidth;
            const double width =
                std::max((axis.at(bar.to_s) - axis.at(bar.from_s)) / length * kWidth, 0.7);
            svg += fmt::format("<rect x='{:.2f}' y='{:.1f}' width='{:.2f}' height='{:.0f}' "
                               "class='{}'><title>{}</title></rect>",
                               kLabel + x, y + 2, width, kLane - 4, escaped(bar.kind),
                               escaped(bar.title));
        }
        y += kLane;
    }
    return svg + "</svg>";
}

} // namespace hsgm::pipeline
