#include "pipeline/bench/report.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace hsgm::bench {

namespace {

using nlohmann::ordered_json;

ordered_json seconds_json(const std::vector<double>& all)
{
    const auto [least, most] = std::minmax_element(all.begin(), all.end());
    return {{"median", median(all)}, {"least", *least}, {"most", *most}, {"all", all}};
}

ordered_json memory_json(const std::optional<PeakBytes>& memory)
{
    return memory ? ordered_json{{"peak", memory->peak}, {"added", memory->added}}
                  : ordered_json();
}

ordered_json contender_json(const Contender& c)
{
    ordered_json json;
    json["title"] = c.title;
    json["matcher"] = c.peer ? "opencv" : "hsgm";
    json["mode"] = c.peer ? name(*c.peer) : name(c.options.mode);
    if (!c.peer) {
        const matcher::Options o = c.options.resolved();
        json["cost"] = name(o.cost);
        json["paths"] = o.paths;
        json["prune"] = o.prune;
        json["instructions"] =
            c.instructions ? ordered_json(name(*c.instructions)) : ordered_json("auto");
        json["device"] = c.device ? "cuda:" + std::to_string(c.device->number) : "cpu";
    }
    json["threads"] = c.threads;
    return json;
}

ordered_json measured_json(const Measured& m, const PairResult& pair)
{
    ordered_json json = contender_json(m.contender);
    const double seconds = m.median_s();
    json["compared_with"] = pair.measured[m.contender.base].contender.title;
    json["seconds"] = seconds_json(m.seconds);
    json["cpu_seconds"] = seconds_json(m.cpu_seconds);
    json["time_over_base"] = m.time_over_base();
    const auto rate = [seconds](std::int64_t cells) {
        return static_cast<double>(cells) / seconds;
    };
    json["cells_per_s"] = {{"compared", rate(pair.compared_cells())},
                           {"nominal", rate(pair.nominal_cells())},
                           {"evaluated", rate(pair.evaluated_cells(m))}};
    json["memory_bytes"] = memory_json(m.memory);
    json["bad_percent"] = m.bad_percent ? ordered_json(*m.bad_percent) : ordered_json();
    if (!m.contender.peer) {
        json["work"] = {{"windows", m.work.windows},
                        {"cells", m.work.cells},
                        {"path_steps", m.work.path_steps}};
        json["stages_s"] = {{"pyramid", m.stages.pyramid},
                            {"table", m.stages.table},
                            {"coarse", m.stages.coarse},
                            {"windows", m.stages.windows},
                            {"second", m.stages.second}};
    }
    return json;
}

ordered_json pair_json(const PairResult& pair)
{
    ordered_json json;
    json["source"] = pair.source;
    json["rows"] = pair.shape.left.rows;
    json["cols"] = pair.shape.left.cols;
    json["disparity_min"] = pair.shape.asked.min;
    json["disparity_max"] = pair.shape.asked.max;
    json["compared_cols"] = compared_columns(pair.shape).count();
    json["cells"] = {{"nominal", pair.nominal_cells()}, {"compared", pair.compared_cells()}};
    json["span"] = {{"of", pair.span_of_truth ? "truth" : "result"},
                    {"low_px", pair.span.low_px},
                    {"high_px", pair.span.high_px},
                    {"percent", pair.span.percent}};
    json["measured"] = ordered_json::array();
    for (const Measured& m : pair.measured) {
        json["measured"].push_back(measured_json(m, pair));
    }
    json["left_out"] = ordered_json::array();
    for (const LeftOut& l : pair.left_out) {
        ordered_json left_out = contender_json(l.contender);
        left_out["why"] = l.why;
        json["left_out"].push_back(left_out);
    }
    json["whole"] = ordered_json();
    if (pair.whole) {
        json["whole"] = {{"threads", pair.whole->threads},
                         {"tile_size_px", pair.whole->tile_size_px},
                         {"seconds", seconds_json(pair.whole->seconds)},
                         {"memory_bytes", memory_json(pair.whole->memory)}};
    }
    return json;
}

} // namespace

std::string json(const BenchResult& result)
{
    ordered_json all;
    all["version"] = HSGM_VERSION;
    all["machine"] = machine();
    all["repeats"] = result.settings.repeats;
    all["tile_size_px"] = result.settings.tile_size_px;
    all["inner_loops"] = ordered_json::array();
    for (const InnerRate& rate : result.inner) {
        all["inner_loops"].push_back(
            {{"instructions", rate.instructions ? ordered_json(name(*rate.instructions))
                                                : ordered_json("auto")},
             {"path_bits", rate.path_bits},
             {"cells_per_s", rate.cells_per_s}});
    }
    all["pairs"] = ordered_json::array();
    for (const PairResult& pair : result.pairs) {
        all["pairs"].push_back(pair_json(pair));
    }
    return all.dump(2);
}

} // namespace hsgm::bench
