#include "pipeline/commands/evaluate_dsm.h"

#include "io/error.h"
#include "pipeline/stages/surface_stage.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace hsgm::pipeline {

namespace {

using evaluate::SurfaceScore;
using nlohmann::ordered_json;

constexpr const char* kHelp = R"(Examples:
  hsgm evaluate dsm height.tif truth_dsm.tif
  hsgm evaluate dsm height.tif lidar.tif --mask seen.tif --mask-bits 3 --difference error.tif
  hsgm evaluate dsm height.tif lidar.tif --classes classes.tif --align-classes 0 --exclude-classes 3
  hsgm evaluate dsm height.tif lidar.tif --align up --thresholds 1,3 --json

First the shift of TEST against REFERENCE is found (Nuth and Kaeaeb 2011) and taken out; then
errors are test - reference in metres, at the cells of the reference. A cell without a height in
TEST is not within any threshold. Both must be in one map system with metres, north up; cells
may differ. NMAD is 1.4826 times the median distance from the median error; 90 % of the errors
are at most LE90.)";

struct Options {
    SurfaceQuestion question;
    std::string align = "shift";
    bool json = false;
};

ordered_json score_json(const SurfaceScore& s)
{
    ordered_json within = ordered_json::array();
    for (const evaluate::WithinThreshold& w : s.within) {
        within.push_back({{"threshold_m", w.threshold_m},
                          {"percent", w.percent},
                          {"answered_percent", w.answered_percent}});
    }
    return {{"evaluated_cells", s.evaluated},
            {"answered_cells", s.answered},
            {"completeness_percent", s.completeness_percent},
            {"within", within},
            {"mean_error_m", s.mean_error_m},
            {"median_error_m", s.median_error_m},
            {"rmse_m", s.rmse_m},
            {"nmad_m", s.nmad_m},
            {"le90_m", s.le90_m}};
}

void print_json(const SurfaceAnswer& answer, Alignment alignment)
{
    ordered_json json;
    if (alignment != Alignment::none) {
        json["shift"] = {{"east_m", answer.shift.east},
                         {"north_m", answer.shift.north},
                         {"up_m", answer.shift.up},
                         {"horizontal_found", answer.horizontal},
                         {"cells", answer.aligned_cells},
                         {"rounds", answer.rounds},
                         {"weakest_slope", answer.weakest_slope}};
    }
    json.update(score_json(answer.all));
    for (const auto& [value, score] : answer.classes) {
        json["classes"][std::to_string(value)] = score_json(score);
    }
    fmt::print("{}\n", json.dump(2));
}

void print_row(const std::string& name, const SurfaceScore& s)
{
    fmt::print("{:<9} {:>10} {:9.2f} %", name, s.evaluated, s.completeness_percent);
    for (const evaluate::WithinThreshold& w : s.within) {
        fmt::print(" {:9.2f} %", w.percent);
    }
    fmt::print(" {:9.3f} {:9.3f} {:9.3f} {:9.3f}\n", s.median_error_m, s.nmad_m, s.rmse_m,
               s.le90_m);
}

void print_table(const SurfaceAnswer& answer, Alignment alignment)
{
    if (alignment != Alignment::none) {
        fmt::print("shift of the test   east {:+.3f} m, north {:+.3f} m, up {:+.3f} m, from {} "
                   "cells in {} rounds\n",
                   answer.shift.east, answer.shift.north, answer.shift.up, answer.aligned_cells,
                   answer.rounds);
        if (alignment == Alignment::shift && !answer.horizontal) {
            fmt::print(
                "the ground shows no horizontal shift; only the height was adjusted (where "
                "it is flattest it slopes by {:.4f} rms, and {:g} at least is needed)\n",
                answer.weakest_slope, evaluate::ShiftFit::kLeastSlope);
        }
        fmt::print("\n");
    }
    fmt::print("{:<9} {:>10} {:>11}", "", "cells", "complete");
    for (const evaluate::WithinThreshold& w : answer.all.within) {
        fmt::print(" {:>11}", fmt::format("within {:g} m", w.threshold_m));
    }
    fmt::print(" {:>9} {:>9} {:>9} {:>9}\n", "median m", "NMAD m", "RMSE m", "LE90 m");
    print_row("all", answer.all);
    for (const auto& [value, score] : answer.classes) {
        print_row("class " + std::to_string(value), score);
    }
}

void run(Options options)
{
    options.question.alignment = options.align == "shift" ? Alignment::shift
                                 : options.align == "up"  ? Alignment::up
                                                          : Alignment::none;
    const SurfaceAnswer answer = score_surface(options.question);
    if (answer.all.evaluated == 0) {
        throw io::InputError("no cell of " + options.question.inputs.reference +
                             " counts; check its nodata value, the mask and the classes");
    }
    if (options.json) {
        print_json(answer, options.question.alignment);
    } else {
        print_table(answer, options.question.alignment);
    }
}

} // namespace

void add_evaluate_dsm(CLI::App& evaluate)
{
    CLI::App* dsm = evaluate.add_subcommand(
        "dsm", "Score a surface model (heights in metres) against a reference");
    dsm->footer(kHelp);
    const auto o = std::make_shared<Options>();
    SurfaceInputs& inputs = o->question.inputs;
    dsm->add_option("TEST", inputs.test, "surface model")->required();
    dsm->add_option("REFERENCE", inputs.reference, "true surface")->required();
    dsm->add_option("--mask", inputs.mask,
                    "raster on the reference's grid whose zeros do not count");
    dsm->add_option("--mask-bits", inputs.mask_bits,
                    "cells count only where the mask has all of these bits");
    dsm->add_option("--classes", inputs.classes,
                    "raster on the reference's grid, a class a cell, 0 to 255: one more row a "
                    "class");
    dsm->add_option("--exclude-classes", inputs.excluded_classes,
                    "classes that do not count, for example 3 or 3,5")
        ->delimiter(',');
    dsm->add_option("--align-classes", o->question.aligned_on,
                    "classes that the shift is found on; all by default")
        ->delimiter(',');
    dsm->add_option("--align", o->align, "what is taken out first: shift, up or none")
        ->check(CLI::IsMember({"shift", "up", "none"}))
        ->capture_default_str();
    dsm->add_option("--thresholds", o->question.thresholds_m, "in metres, for example 0.5,1,2")
        ->delimiter(',')
        ->capture_default_str();
    dsm->add_option("--difference", o->question.difference,
                    "GeoTIFF of the errors to write, NaN where there is none");
    dsm->add_flag("--json", o->json, "print JSON");
    dsm->callback([o] { run(*o); });
}

} // namespace hsgm::pipeline
