#include "pipeline/commands/synth_command.h"

#include "io/pending_file.h"
#include "pipeline/stages/scene_config.h"
#include "pipeline/stages/synth_orbit_stage.h"
#include "pipeline/stages/synth_stage.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace hsgm::pipeline {

namespace {

constexpr const char* kHelp = R"(Examples:
  hsgm synth configs/scene-city.yaml -o city
  hsgm synth configs/scene-city.yaml -o small --set size=[300,400] --set seed=8
  hsgm synth configs/scene-large.yaml -o large --set city.height_max_px=60
  hsgm synth configs/scene-orbit.yaml -o orbit --set cameras.right.turn_deg=180

Writes left.tif and right.tif, truth_left.tif and truth_right.tif (x_left - x_right in
pixels), visible_left.tif (255 = shows in both images) and scene.used.yaml, every key of the
scene with its value.

A scene with a section `cameras` is seen from orbit: left.tif and right.tif are raw images with
RPCs, the truth is on the map: truth_dsm.tif, truth_classes.tif and truth_visible.tif (bit 0
seen in left, bit 1 in right).)";

struct Options {
    std::string scene;
    std::string folder;
    std::vector<std::string> overrides;
};

std::string render_rectified(const synth::Scene& scene, const std::string& folder)
{
    const synth::DisparityBounds bounds = write_scene(scene, folder);
    return fmt::format("{} rows x {} columns, disparities within {:.0f} to {:.0f} px",
                       scene.size.rows, scene.size.cols, std::floor(bounds.min_px),
                       std::ceil(bounds.max_px));
}

std::string render_from_orbit(const SceneConfig& config, const std::string& folder)
{
    const OrbitSceneSummary s = write_orbit_scene(config.scene, *config.cameras, folder);
    return fmt::format("left {} rows x {} columns, right {} x {}, map {} x {} cells of {:g} m, "
                       "heights within {:.0f} to {:.0f} m",
                       s.left.rows, s.left.cols, s.right.rows, s.right.cols,
                       config.scene.size.rows, config.scene.size.cols, config.cameras->cell_m,
                       std::floor(s.lowest_m), std::ceil(s.highest_m));
}

void run(const Options& options)
{
    const SceneConfig config = read_scene(options.scene, options.overrides);
    const std::string summary = config.cameras ? render_from_orbit(config, options.folder)
                                               : render_rectified(config.scene, options.folder);
    io::write_text_file(options.folder + "/scene.used.yaml", config.used_yaml);
    fmt::print("{}: {}\n", options.folder, summary);
}

} // namespace

CLI::App* add_synth_command(CLI::App& app)
{
    CLI::App* command =
        app.add_subcommand("synth", "Render a synthetic stereo pair with exact truth");
    command->footer(kHelp);
    const auto options = std::make_shared<Options>();
    command->add_option("SCENE", options->scene, "scene file (YAML)")->required();
    command->add_option("-o,--output", options->folder, "folder for the result")->required();
    // One value each, as written: the default would take brackets for CLI11's own lists.
    command->add_option("--set", options->overrides, "override a key: key=value")
        ->allow_extra_args(false)
        ->take_all();
    command->callback([options] { run(*options); });
    return command;
}

} // namespace hsgm::pipeline
