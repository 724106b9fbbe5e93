#include "pipeline/stages/synth_stage.h"

#include "io/error.h"
#include "pipeline/stages/raster_strips.h"
#include "pipeline/synth/renderer.h"

#include <cstdint>
#include <stdexcept>

namespace hsgm::pipeline {

namespace {

using tiling::Rect;

synth::Renderer renderer_of(const synth::Scene& scene)
{
    try {
        return synth::Renderer(scene);
    } catch (const std::invalid_argument& refused) {
        throw io::ConfigError(refused.what());
    }
}

} // namespace

synth::DisparityBounds write_scene(const synth::Scene& scene, const std::string& folder)
{
    const synth::Renderer r = renderer_of(scene);
    make_output_folder(folder);
    io::RasterOptions gray;
    gray.nodata = 0;
    gray.band_descriptions = {"gray"};
    write_gray(folder + "/left.tif", scene.size, scene.bits, gray,
               [&](const Rect& part, auto out) { r.render_left(part, out); });
    write_gray(folder + "/right.tif", scene.size, scene.bits, gray,
               [&](const Rect& part, auto out) { r.render_right(part, out); });
    io::RasterOptions truth;
    truth.band_descriptions = {"disparity x_left - x_right"};
    truth.unit = "pixel";
    write_computed<float>(folder + "/truth_left.tif", scene.size, truth,
                          [&](const Rect& part, auto out) { r.truth_left(part, out); });
    write_computed<float>(folder + "/truth_right.tif", scene.size, truth,
                          [&](const Rect& part, auto out) { r.truth_right(part, out); });
    io::RasterOptions visible;
    visible.band_descriptions = {"255 = visible in both images"};
    write_computed<std::uint8_t>(
        folder + "/visible_left.tif", scene.size, visible,
        [&](const Rect& part, auto out) { r.visible_left(part, out); });
    return r.disparity_bounds();
}

} // namespace hsgm::pipeline
