#include "pipeline/commands/evaluate_command.h"

#include "io/error.h"
#include "pipeline/commands/confidence_report.h"
#include "pipeline/commands/evaluate_dsm.h"
#include "pipeline/stages/evaluate_stage.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hsgm::pipeline {

namespace {

using evaluate::DisparityScore;
using evaluate::SeamScore;
using nlohmann::ordered_json;

constexpr const char* kDisparityHelp = R"(Examples:
  hsgm evaluate disparity result.tif truth_left.tif --mask visible_left.tif
  hsgm evaluate disparity result.tif disp_left_x4.png --scale 4 --thresholds 1,2
  hsgm evaluate disparity result.tif left.pfm --truth-right right.pfm
  hsgm evaluate disparity result.tif truth.tif --nonoccluded zbuffer --json
  hsgm evaluate disparity result.tif truth.tif --confidence result.confidence.tif

A pixel is bad where it has no value, or where |d - truth| is above the threshold. Pixels
without truth, and those that the mask or the search for occlusions leaves out, do not count.

With --confidence, a second table tells how errors go away with the least confident pixels,
and a third whether confidence / 255 is the share of pixels within --confidence-px.)";

constexpr const char* kSeamsHelp = R"(Examples:
  hsgm evaluate seams result.tif --window 64
  hsgm evaluate seams result.tif --window 64 --tile 1024
  hsgm evaluate seams result.tif --truth truth_left.tif --mask visible_left.tif

The ratio is the mean jump between neighbours on two sides of a border to the mean jump more
than 4 px from every border, with a 95 % interval. 1: the borders do not show. With a truth,
the jumps are those of the error; without, those of the disparity itself.)";

struct Options {
    DisparityInputs inputs;
    std::string truth_nodata;
    std::string nonoccluded;
    std::vector<double> thresholds_px{0.5, 1, 2, 4};
    double confidence_px = 1;
    int window_px = 0;
    int tile_px = 0;
    bool json = false;
};

double parse_nodata(const std::string& text)
{
    if (text == "none") {
        return std::numeric_limits<double>::quiet_NaN();
    }
    double value = 0;
    if (!CLI::detail::lexical_cast(text, value)) {
        throw io::ConfigError("--truth-nodata is '" + text + "'; allowed: a number, or none");
    }
    return value;
}

DisparityInputs inputs_of(const Options& options)
{
    DisparityInputs inputs = options.inputs;
    if (!options.truth_nodata.empty()) {
        inputs.truth_nodata = parse_nodata(options.truth_nodata);
    }
    inputs.zbuffer = options.nonoccluded == "zbuffer";
    return inputs;
}

void print(const ordered_json& json)
{
    fmt::print("{}\n", json.dump(2));
}

ordered_json score_json(const DisparityScore& s)
{
    ordered_json bad = ordered_json::array();
    for (const evaluate::BadPixels& b : s.bad) {
        bad.push_back({{"threshold_px", b.threshold_px},
                       {"bad_percent", b.bad_percent},
                       {"bad_answered_percent", b.bad_answered_percent}});
    }
    return {{"evaluated_pixels", s.evaluated},
            {"answered_pixels", s.answered},
            {"density_percent", s.density_percent},
            {"bad", bad},
            {"mean_error_px", s.mean_error_px},
            {"mean_absolute_error_px", s.mean_absolute_error_px},
            {"rmse_px", s.rmse_px},
            {"median_error_px", s.median_error_px},
            {"nmad_px", s.nmad_px}};
}

void print_score(const DisparityScore& s)
{
    fmt::print("evaluated        {:>12} px\n", s.evaluated);
    fmt::print("answered         {:>12} px  {:8.3f} %\n\n", s.answered, s.density_percent);
    fmt::print("error above              all   answered\n");
    for (const evaluate::BadPixels& b : s.bad) {
        fmt::print("{:8g} px      {:10.3f} % {:8.3f} %\n", b.threshold_px, b.bad_percent,
                   b.bad_answered_percent);
    }
    fmt::print("\nmean error       {:12.4f} px\n", s.mean_error_px);
    fmt::print("mean |error|     {:12.4f} px\n", s.mean_absolute_error_px);
    fmt::print("RMSE             {:12.4f} px\n", s.rmse_px);
    fmt::print("median error     {:12.4f} px\n", s.median_error_px);
    fmt::print("NMAD             {:12.4f} px\n", s.nmad_px);
}

using NamedSeams = std::vector<std::pair<std::string, SeamScore>>;

void print_seams_as_json(const NamedSeams& seams)
{
    ordered_json all;
    for (const auto& [name, s] : seams) {
        all[name] = {{"ratio", s.ratio},
                     {"ratio_low", s.ratio_low},
                     {"ratio_high", s.ratio_high},
                     {"border_jump_px", s.border_jump_px},
                     {"far_jump_px", s.far_jump_px},
                     {"border_pairs", s.border_pairs},
                     {"far_pairs", s.far_pairs}};
    }
    print(all);
}

void print_seams(const NamedSeams& seams)
{
    fmt::print("{:<14} {:>7}  {:<17} {:>11} {:>11} {:>12} {:>12}\n", "borders of", "ratio",
               "95 % interval", "jump there", "elsewhere", "pairs there", "elsewhere");
    for (const auto& [name, s] : seams) {
        fmt::print("{:<14} {:7.4f}  {:7.4f} - {:7.4f} {:8.4f} px {:8.4f} px {:>12} {:>12}\n",
                   name, s.ratio, s.ratio_low, s.ratio_high, s.border_jump_px, s.far_jump_px,
                   s.border_pairs, s.far_pairs);
    }
}

void run_seams(const Options& options)
{
    std::vector<int> cells_px;
    NamedSeams seams;
    const auto add = [&](const char* name, int cell_px) {
        seams.emplace_back(name + std::to_string(cell_px), SeamScore{});
        cells_px.push_back(cell_px);
    };
    // The default window of the matcher, where nothing is said.
    const bool none = options.window_px == 0 && options.tile_px == 0;
    if (options.window_px != 0 || none) {
        add("window_", none ? 64 : options.window_px);
    }
    if (options.tile_px != 0) {
        add("tile_", options.tile_px);
    }
    const std::vector<SeamScore> scores = score_seams(inputs_of(options), cells_px);
    for (std::size_t i = 0; i < scores.size(); ++i) {
        seams[i].second = scores[i];
    }
    options.json ? print_seams_as_json(seams) : print_seams(seams);
}

void run_disparity(const Options& options)
{
    const DisparityScore score = score_disparity(inputs_of(options), options.thresholds_px);
    if (score.evaluated == 0) {
        throw io::InputError("no pixel of " + options.inputs.truth +
                             " has a truth that counts; check its nodata value and the mask");
    }
    std::optional<evaluate::ConfidenceScore> confidence;
    if (!options.inputs.confidence.empty()) {
        confidence = score_confidence(inputs_of(options), options.confidence_px);
    }
    if (options.json) {
        ordered_json json = score_json(score);
        if (confidence) {
            json["confidence"] = confidence_json(*confidence);
        }
        print(json);
        return;
    }
    print_score(score);
    if (confidence) {
        print_confidence(*confidence);
    }
}

// What both commands know about their rasters.
void add_raster_options(CLI::App& command, Options& o)
{
    command.add_option("--mask", o.inputs.mask, "raster whose zeros do not count");
    command.add_option("--mask-value", o.inputs.mask_value,
                       "only pixels with this value of the mask count");
    command
        .add_option("--scale", o.inputs.truth_scale,
                    "stored values of the truth per pixel of disparity")
        ->capture_default_str();
    command.add_option("--test-scale", o.inputs.test_scale, "likewise of the map under test")
        ->capture_default_str();
    command.add_option("--truth-nodata", o.truth_nodata,
                       "stored value that means unknown truth, or none; by default what the "
                       "file declares, and 0 where it stores integers");
    command.add_option("--truth-right", o.inputs.truth_right,
                       "truth of the right view: pixels on which both disagree by more than "
                       "1 px do not count");
    command
        .add_option("--nonoccluded", o.nonoccluded,
                    "zbuffer: pixels behind something nearer, by the truth of the left "
                    "view alone, do not count")
        ->check(CLI::IsMember({"zbuffer"}));
    command.add_flag("--json", o.json, "print JSON");
}

} // namespace

CLI::App* add_evaluate_command(CLI::App& app)
{
    CLI::App* evaluate = app.add_subcommand("evaluate", "Measure results");
    evaluate->require_subcommand(1);

    CLI::App* disparity = evaluate->add_subcommand(
        "disparity", "Score a disparity map (x_left - x_right, in pixels) against truth");
    disparity->footer(kDisparityHelp);
    const auto d = std::make_shared<Options>();
    disparity->add_option("TEST", d->inputs.test, "disparity map")->required();
    disparity->add_option("TRUTH", d->inputs.truth, "true disparity")->required();
    disparity->add_option("--thresholds", d->thresholds_px, "in pixels, for example 0.5,1,2,4")
        ->delimiter(',')
        ->capture_default_str();
    disparity->add_option("--confidence", d->inputs.confidence,
                          "raster of the map's confidence, 0 to 255: tells what it is worth");
    disparity
        ->add_option("--confidence-px", d->confidence_px,
                     "the error above which a pixel is bad for that")
        ->capture_default_str();
    add_raster_options(*disparity, *d);
    disparity->callback([d] { run_disparity(*d); });

    CLI::App* seams = evaluate->add_subcommand(
        "seams", "Measure steps of a disparity map at the borders of windows or tiles");
    seams->footer(kSeamsHelp);
    const auto s = std::make_shared<Options>();
    seams->add_option("DISPARITY", s->inputs.test, "disparity map")->required();
    seams->add_option("--truth", s->inputs.truth, "true disparity");
    seams->add_option("--window", s->window_px, "side of the matcher's windows; 64 by default")
        ->check(CLI::Range(2, 1 << 20));
    seams->add_option("--tile", s->tile_px, "side of the tiles")->check(CLI::Range(2, 1 << 20));
    add_raster_options(*seams, *s);
    seams->callback([s] { run_seams(*s); });
    add_evaluate_dsm(*evaluate);
    return evaluate;
}

} // namespace hsgm::pipeline
