#include "pipeline/commands/plan_report.h"

#include "pipeline/stages/part_plan.h"
#include "pipeline/time_estimate.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hsgm::pipeline {

namespace {

double mebi(std::int64_t bytes)
{
    return static_cast<double>(bytes) / (1 << 20);
}

/// What is printed: worked out once, for both forms.
struct Told {
    const PlannedJob& planned;
    std::vector<PlannedPart> parts;
    std::optional<TimeEstimate> time;
};

double tenths(double seconds)
{
    return std::round(seconds * 10) / 10;
}

nlohmann::ordered_json levels_json(const matcher::LevelPlan& levels)
{
    auto list = nlohmann::ordered_json::array();
    for (std::size_t k = 0; k < levels.ranges.size(); ++k) {
        list.push_back({{"level", k},
                        {"rows", levels.left_sizes[k].rows},
                        {"cols", levels.left_sizes[k].cols},
                        {"disparity_min", levels.ranges[k].min},
                        {"disparity_max", levels.ranges[k].max}});
    }
    return list;
}

nlohmann::ordered_json devices_json(const DevicePlan& plan)
{
    auto list = nlohmann::ordered_json::array();
    if (plan.cpu) {
        list.push_back({{"device", "cpu"}});
    }
    for (const PlannedDevice& device : plan.cuda) {
        list.push_back({{"device", fmt::format("cuda:{}", device.info.number)},
                        {"name", device.info.name},
                        {"streams", device.streams},
                        {"memory_bytes", device.bytes}});
    }
    return list;
}

nlohmann::ordered_json parts_json(const Told& told)
{
    auto list = nlohmann::ordered_json::array();
    for (const PlannedPart& part : told.parts) {
        nlohmann::ordered_json json{{"part", part.name}};
        if (part.stage == RunStage::tiles) {
            json["first_row"] = part.rows.row;
            json["rows"] = part.rows.rows;
            json["tiles"] = part.tiles;
        }
        json["memory_bytes"] = part.memory_bytes;
        json["disk_bytes"] = part.disk_bytes;
        list.push_back(json);
    }
    return list;
}

nlohmann::ordered_json time_json(const Told& told)
{
    const TimeEstimate& t = *told.time;
    nlohmann::ordered_json json{
        {"measured_ns_per_px",
         {{"match", tenths(t.match_ns_per_px)}, {"refine", tenths(t.refine_ns_per_px)}}},
        {"prepare_s", tenths(t.prepare_s)},
        {"coarse_s", tenths(t.coarse_s)},
        {"tiles_s", tenths(t.tiles_s)},
        {"assemble_s", tenths(t.assemble_s)},
        {"all_s", tenths(t.all_s())}};
    if (!told.parts.empty()) {
        auto list = nlohmann::ordered_json::array();
        for (const PlannedPart& part : told.parts) {
            list.push_back(tenths(t.part_s(part, told.planned.shape)));
        }
        json["parts_s"] = list;
        json["side_by_side_s"] = tenths(t.side_by_side_s(told.parts, told.planned.shape));
    }
    return json;
}

nlohmann::ordered_json plan_json(const Told& told)
{
    const PlannedJob& planned = told.planned;
    const Budget& b = planned.budget;
    nlohmann::ordered_json json;
    json["mode"] = name(planned.job.matcher.mode);
    json["cost"] = name(planned.job.matcher.cost);
    json["levels"] = levels_json(planned.levels);
    json["tile_size_px"] = b.tile_size_px;
    json["tiles"] = b.tiles;
    json["tiles_in_flight"] = b.tiles_in_flight;
    json["threads"] = b.threads;
    json["devices"] = devices_json(planned.devices);
    json["memory_bytes"] = {{"allowed", b.memory_bytes},  {"estimate", b.estimate_bytes},
                            {"prepare", b.prepare_bytes}, {"coarse", b.coarse_bytes},
                            {"tiles", b.tiles_bytes},     {"refine", b.refine_bytes}};
    json["disk_bytes"] = {{"scratch", b.scratch_disk_bytes}, {"outputs", b.output_disk_bytes}};
    if (!told.parts.empty()) {
        json["parts"] = parts_json(told);
    }
    if (told.time) {
        json["time"] = time_json(told);
    }
    return json;
}

void print_levels(const PlannedJob& planned)
{
    fmt::print("mode      {}, {}\n", name(planned.job.matcher.mode),
               name(planned.job.matcher.cost));
    for (std::size_t k = 0; k < planned.levels.ranges.size(); ++k) {
        fmt::print("level {:<3} {} x {} px, disparities {}..{}\n", k,
                   planned.levels.left_sizes[k].cols, planned.levels.left_sizes[k].rows,
                   planned.levels.ranges[k].min, planned.levels.ranges[k].max);
    }
}

void print_parts(const Told& told)
{
    fmt::print("\n{:<14} {:>13} {:>7} {:>12} {:>10}{}\n", "part", "rows", "tiles", "memory MiB",
               "disk MiB", told.time ? "    time" : "");
    for (const PlannedPart& part : told.parts) {
        const bool shard = part.stage == RunStage::tiles;
        const std::string rows =
            part.rows.empty() ? "none"
                              : fmt::format("{}-{}", part.rows.row, part.rows.row_end() - 1);
        const double seconds = told.time ? told.time->part_s(part, told.planned.shape) : 0;
        fmt::print("{:<14} {:>13} {:>7} {:>12.0f} {:>10.0f}{}\n", part.name, shard ? rows : "",
                   shard ? std::to_string(part.tiles) : "", std::ceil(mebi(part.memory_bytes)),
                   std::ceil(mebi(part.disk_bytes)),
                   told.time && seconds > 0 ? fmt::format("{:>8}", rough_time(seconds)) : "");
    }
    if (told.time) {
        fmt::print("side by side, on machines like this one: about {}\n",
                   rough_time(told.time->side_by_side_s(told.parts, told.planned.shape)));
    }
}

void print_table(const Told& told)
{
    const PlannedJob& planned = told.planned;
    const Budget& b = planned.budget;
    print_levels(planned);
    fmt::print("tiles     {}\n", tile_text(b));
    fmt::print("threads   {}\n", b.threads);
    fmt::print("devices   {}\n", planned.devices.text());
    fmt::print(
        "memory    {:.0f} MiB at most, of {:.0f} allowed (prepare {:.0f}, coarse {:.0f}, "
        "tiles {:.0f}, refine {:.0f})\n",
        mebi(b.estimate_bytes), mebi(b.memory_bytes), mebi(b.prepare_bytes),
        mebi(b.coarse_bytes), mebi(b.tiles_bytes), mebi(b.refine_bytes));
    fmt::print("disk      {:.0f} MiB scratch, at most {:.0f} MiB results\n",
               mebi(b.scratch_disk_bytes), mebi(b.output_disk_bytes));
    if (told.time) {
        const TimeEstimate& t = *told.time;
        fmt::print("time      about {} here{} (prepare {}, coarse {}, tiles {}, assemble {})\n",
                   rough_time(t.all_s()),
                   planned.devices.cuda.empty() ? "" : ", without the devices",
                   rough_time(t.prepare_s), rough_time(t.coarse_s), rough_time(t.tiles_s),
                   rough_time(t.assemble_s));
    }
    if (!told.parts.empty()) {
        print_parts(told);
    }
}

} // namespace

std::string tile_text(const Budget& budget)
{
    if (budget.tile_size_px == 0) {
        return "untiled";
    }
    return fmt::format("{} of {} px, {} in flight", budget.tiles, budget.tile_size_px,
                       budget.tiles_in_flight);
}

void print_plan(const PlannedJob& planned, const PlanReport& report)
{
    Told told{planned, {}, {}};
    if (report.shards) {
        told.parts = plan_parts(planned, *report.shards);
    }
    if (report.time) {
        told.time = estimate_time(planned);
    }
    if (report.json) {
        fmt::print("{}\n", plan_json(told).dump(2));
    } else {
        print_table(told);
    }
}

} // namespace hsgm::pipeline
