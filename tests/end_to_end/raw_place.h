#pragma once

#include "tests/end_to_end/pairs.h"
#include "tests/end_to_end/rasters.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace hsgm::tests {

using nlohmann::json;

inline constexpr const char* kRawScene = R"(
size: [420, 420]
seed: 5
bits: 11
cameras:
  crs: EPSG:32633
  west: 500000
  north: 5300000
  cell_m: 0.5
  base_m: 320
  pixel_m: 0.5
  left: {toward_east: 0.14, toward_north: 0.06, turn_deg: 3}
  right: {toward_east: -0.17, toward_north: -0.03, turn_deg: TURN, written_col_px: 1.1, written_row_px: -1.7}
terrain:
  waves: # two ways, or co-registration has nothing to hold on to
    - {amplitude_px: 6, wavelength_px: 400, direction_deg: 35}
    - {amplitude_px: 4, wavelength_px: 300, direction_deg: 120}
  texture: {mean: 0.4, contrast: 0.06, finest_px: 2.5, octaves: 4}
city:
  cell_px: 96
  street_px: 16
  fill: 0.75
  height_min_px: 3
  height_max_px: 20
  texture: {mean: 0.42, contrast: 0.07, finest_px: 2.5, octaves: 4}
left: {noise_gray: 5}
right: {gain: 0.9, offset: 0.03, gamma: 1.08, noise_gray: 5}
)";

inline constexpr const char* kRawRun = "pair: {left: scene/left.tif, right: scene/right.tif}\n"
                                       "geometry: {kind: rpc}\n"
                                       "output: {folder: result}\n";

/// A DSM against the truth of its scene, on land that both images see.
inline json score_of(const std::string& dsm, const std::string& scene)
{
    return json::parse(
        hsgm_does({"evaluate", "dsm", dsm, scene + "/truth_dsm.tif", "--mask",
                   scene + "/truth_visible.tif", "--mask-bits", "3", "--classes",
                   scene + "/truth_classes.tif", "--align-classes", "0", "--json"})
            .out);
}

/// The scene, its right image turned by so many degrees, and a configuration for it.
class RawPlace {
public:
    explicit RawPlace(const std::string& turn_deg = "-2")
    {
        std::string scene = kRawScene;
        scene.replace(scene.find("TURN"), 4, turn_deg);
        put_bytes(folder_ / "scene.yaml", scene);
        put_bytes(folder_ / "run.yaml", kRawRun);
        hsgm_does({"synth", folder_ / "scene.yaml", "-o", folder_ / "scene"});
    }
    std::string operator/(const std::string& name) const { return folder_ / name; }

    Outcome run(const std::string& result, std::vector<std::string> more = {}) const
    {
        more.insert(more.begin(),
                    {"run", folder_ / "run.yaml", "-o", folder_ / result, "--threads", "2"});
        return run_hsgm(more);
    }
    json score(const std::string& result) const
    {
        return score_of(folder_ / (result + "/dsm.tif"), folder_ / "scene");
    }

private:
    TemporaryFolder folder_;
};

inline void says(const Outcome& outcome, int code, const std::string& part)
{
    CAPTURE(outcome.err, part);
    CHECK(outcome.code == code);
    CHECK(outcome.err.find(part) != std::string::npos);
}

} // namespace hsgm::tests
