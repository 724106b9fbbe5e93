#include "pipeline/stages/synth_orbit_stage.h"

#include "io/error.h"
#include "io/rpc_metadata.h"
#include "pipeline/geometry/map_projection.h"
#include "pipeline/stages/raster_strips.h"
#include "pipeline/stages/synth_ortho_stage.h"
#include "pipeline/synth/hash.h"
#include "pipeline/synth/overhead_renderer.h"

#include <algorithm>
#include <stdexcept>

namespace hsgm::pipeline {

namespace {

using tiling::ImageView;
using tiling::Rect;

// Children of the scene's seed.
enum SeedOf : std::uint64_t { kLeftNoise = 2001, kRightNoise = 2002 };

io::RpcMetadata metadata_of(const geometry::RpcModel& m)
{
    io::RpcMetadata rpc;
    rpc.line_off = m.line_off;
    rpc.samp_off = m.samp_off;
    rpc.lat_off = m.lat_off_deg;
    rpc.long_off = m.long_off_deg;
    rpc.height_off = m.height_off_m;
    rpc.line_scale = m.line_scale;
    rpc.samp_scale = m.samp_scale;
    rpc.lat_scale = m.lat_scale_deg;
    rpc.long_scale = m.long_scale_deg;
    rpc.height_scale = m.height_scale_m;
    rpc.line_num = m.line_num;
    rpc.line_den = m.line_den;
    rpc.samp_num = m.samp_num;
    rpc.samp_den = m.samp_den;
    return rpc;
}

/// The rasters of one scene.
class OrbitScene {
public:
    OrbitScene(const synth::Scene& scene, const SceneCameras& cameras)
        : scene_(scene), cameras_(cameras), renderer_(scene),
          left_(cameras, cameras.left, scene.size, renderer_.heights_m()),
          right_(cameras, cameras.right, scene.size, renderer_.heights_m())
    {
        truth_.geo.transform = {cameras.west,   cameras.cell_m, 0, cameras.north, 0,
                                -cameras.cell_m};
        truth_.geo.wkt = geometry::MapProjection::from_text(cameras.crs).wkt();
        rpc_left_ = io::rpc_items(metadata_of(left_.written_model()));
        rpc_right_ = io::rpc_items(metadata_of(right_.written_model()));
    }

    void write(const std::string& folder) const
    {
        write_image(folder + "/left.tif", left_, scene_.left, rpc_left_, kLeftNoise);
        write_image(folder + "/right.tif", right_, scene_.right, rpc_right_, kRightNoise);
        write_heights(folder + "/truth_dsm.tif");
        io::RasterOptions classes = truth_;
        classes.band_descriptions = {"0 ground, 1 object, 4 ground of low texture"};
        write_computed<std::uint8_t>(
            folder + "/truth_classes.tif", scene_.size, classes,
            [&](const Rect& part, auto out) { renderer_.classes(part, out); });
        write_seen(folder + "/truth_visible.tif");
        if (cameras_.ortho) {
            write_orthos(scene_, cameras_, renderer_, folder);
        }
    }

    OrbitSceneSummary summary() const
    {
        const synth::DisparityBounds heights_m = renderer_.heights_m();
        return {left_.image_size(), right_.image_size(), cameras_.base_m + heights_m.min_px,
                cameras_.base_m + heights_m.max_px};
    }

private:
    void write_image(const std::string& path, const OrbitCamera& orbit,
                     const synth::Sensor& sensor, const std::map<std::string, std::string>& rpc,
                     std::uint64_t child) const
    {
        io::RasterOptions options;
        options.nodata = 0;
        options.band_descriptions = {"gray"};
        options.rpc = rpc;
        const synth::Camera camera(sensor, orbit.image_size(), scene_.full_scale(),
                                   synth::child_seed(scene_.seed, child));
        write_gray(path, orbit.image_size(), scene_.bits, options,
                   [&](const Rect& part, ImageView<std::uint16_t> out) {
                       renderer_.render(
                           [&](double col, double row) { return orbit.ray(col, row); }, camera,
                           part, out);
                   });
    }

    void write_heights(const std::string& path) const
    {
        io::RasterOptions options = truth_;
        options.band_descriptions = {"height above the WGS84 ellipsoid"};
        options.unit = "metre";
        const auto base_m = static_cast<float>(cameras_.base_m);
        write_computed<float>(path, scene_.size, options,
                              [&](const Rect& part, ImageView<float> out) {
                                  renderer_.heights(part, out);
                                  for (int r = 0; r < part.rows; ++r) {
                                      std::for_each(out.row(r), out.row(r) + part.cols,
                                                    [&](float& v) { v += base_m; });
                                  }
                              });
    }

    void write_seen(const std::string& path) const
    {
        io::RasterOptions options = truth_;
        options.band_descriptions = {"bit 0 seen in left, bit 1 in right"};
        const auto seen = [&](const OrbitCamera& orbit, std::uint8_t bit, const Rect& part,
                              ImageView<std::uint8_t> out) {
            renderer_.add_seen(
                [&](double x, double y, double h) { return orbit.ray_through(x, y, h); }, bit,
                part, out);
        };
        write_computed<std::uint8_t>(path, scene_.size, options,
                                     [&](const Rect& part, ImageView<std::uint8_t> out) {
                                         seen(left_, 1, part, out);
                                         seen(right_, 2, part, out);
                                     });
    }

    synth::Scene scene_;
    SceneCameras cameras_;
    synth::OverheadRenderer renderer_;
    OrbitCamera left_;
    OrbitCamera right_;
    io::RasterOptions truth_;
    std::map<std::string, std::string> rpc_left_;
    std::map<std::string, std::string> rpc_right_;
};

} // namespace

OrbitSceneSummary write_orbit_scene(const synth::Scene& scene, const SceneCameras& cameras,
                                    const std::string& folder)
{
    try {
        cameras.validate();
        const OrbitScene orbit(scene, cameras);
        make_output_folder(folder);
        orbit.write(folder);
        return orbit.summary();
    } catch (const std::invalid_argument& refused) {
        throw io::ConfigError(refused.what());
    }
}

} // namespace hsgm::pipeline
