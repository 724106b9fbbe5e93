#include "pipeline/stages/synth_ortho_stage.h"

#include "pipeline/geometry/elevation_grid.h"
#include "pipeline/geometry/map_projection.h"
#include "pipeline/stages/raster_strips.h"
#include "pipeline/synth/hash.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace hsgm::pipeline {

namespace {

using tiling::ImageView;
using tiling::Rect;

// Children of the scene's seed.
enum SeedOf : std::uint64_t { kDemErrors = 2101, kLeftNoise = 2102, kRightNoise = 2103 };

constexpr int kPostsOutside = 3;
constexpr double kDegree = std::numbers::pi / 180;

class OrthoScene {
public:
    OrthoScene(const synth::Scene& scene, const SceneCameras& cameras,
               const synth::OverheadRenderer& renderer)
        : scene_(scene), cameras_(cameras), renderer_(renderer),
          map_(geometry::MapProjection::from_text(cameras.crs)), dem_(make_dem())
    {
    }

    void write(const std::string& folder) const
    {
        write_image(folder + "/ortho_left.tif", cameras_.left, scene_.left, kLeftNoise);
        write_image(folder + "/ortho_right.tif", cameras_.right, scene_.right, kRightNoise);
        io::RasterOptions options;
        options.geo = {dem_.grid().corner_transform(), map_.wkt()};
        options.band_descriptions = {"height above the WGS84 ellipsoid"};
        options.unit = "metre";
        write_computed<float>(folder + "/reference_dem.tif", dem_.posts().size(), options,
                              [&](const Rect& part, ImageView<float> out) {
                                  for (int r = 0; r < part.rows; ++r) {
                                      for (int c = 0; c < part.cols; ++c) {
                                          out(r, c) = dem_.posts()(part.row + r, part.col + c);
                                      }
                                  }
                              });
    }

private:
    /// The terrain at the posts, each with an error of its own.
    geometry::ElevationGrid make_dem() const
    {
        const Posts posts = this->posts();
        tiling::Image<float> heights(posts.size);
        const std::uint64_t seed = synth::child_seed(scene_.seed, kDemErrors);
        for (int r = 0; r < posts.size.rows; ++r) {
            for (int c = 0; c < posts.size.cols; ++c) {
                const double ground =
                    renderer_.ground_m((c - kPostsOutside) * posts.cells - 0.5,
                                       (r - kPostsOutside) * posts.cells - 0.5);
                const double error = cameras_.ortho->dem_error_m *
                                     synth::uniform_signed(synth::hash_at(seed, r, c));
                heights(r, c) = static_cast<float>(cameras_.base_m + ground + error);
            }
        }
        const double step_m = posts.cells * cameras_.cell_m;
        const double outside_m = (kPostsOutside + 0.5) * step_m;
        return {geometry::MapGrid({cameras_.west - outside_m, step_m, 0,
                                   cameras_.north + outside_m, 0, -step_m}),
                cameras_.crs, std::move(heights)};
    }

    struct Posts {
        double cells;
        tiling::Size size;
    };
    Posts posts() const
    {
        const int cells = cameras_.ortho->dem_post_cells;
        const auto count = [cells](int side) {
            return tiling::ceil_div(side, cells) + 1 + 2 * kPostsOutside;
        };
        return {double(cells), {count(scene_.size.rows), count(scene_.size.cols)}};
    }

    /// Height above the base of the surface that orthoimages are made on.
    double surface_m(double x, double y) const
    {
        if (cameras_.ortho->plane_m) {
            return *cameras_.ortho->plane_m - cameras_.base_m;
        }
        const double cells = cameras_.ortho->dem_post_cells;
        return dem_.height_m(
                   {(x + 0.5) / cells + kPostsOutside, (y + 0.5) / cells + kPostsOutside}) -
               cameras_.base_m;
    }

    /// Of the satellite as seen from the middle of the map, whose north is not quite true
    /// north.
    std::pair<double, double> azimuth_and_incidence(const OrbitView& view) const
    {
        const geometry::MapPoint middle{cameras_.west + scene_.size.cols * cameras_.cell_m / 2,
                                        cameras_.north - scene_.size.rows * cameras_.cell_m / 2,
                                        cameras_.base_m};
        const auto ground = map_.inverse(middle);
        const auto north =
            map_.forward({ground.longitude_deg, ground.latitude_deg + 1e-4, ground.height_m});
        const double grid_of_north = std::atan2(north.x - middle.x, north.y - middle.y);
        const double on_grid = std::atan2(view.toward_east, view.toward_north);
        const double azimuth = (on_grid - grid_of_north) / kDegree;
        return {azimuth < 0 ? azimuth + 360 : azimuth,
                std::atan(std::hypot(view.toward_east, view.toward_north)) / kDegree};
    }

    void write_image(const std::string& path, const OrbitView& view,
                     const synth::Sensor& sensor, std::uint64_t child) const
    {
        io::RasterOptions options;
        options.nodata = 0;
        options.band_descriptions = {"gray"};
        options.geo = {std::array{cameras_.west, cameras_.cell_m, 0.0, cameras_.north, 0.0,
                                  -cameras_.cell_m},
                       map_.wkt()};
        const auto [azimuth, incidence] = azimuth_and_incidence(view);
        options.metadata["VIEW_AZIMUTH_DEG"] = fmt::format("{:.9f}", azimuth);
        options.metadata["VIEW_INCIDENCE_DEG"] = fmt::format("{:.9f}", incidence);
        const synth::Camera camera(sensor, scene_.size, scene_.full_scale(),
                                   synth::child_seed(scene_.seed, child));
        const double east = view.toward_east / cameras_.cell_m;
        const double south = -view.toward_north / cameras_.cell_m;
        const auto ray = [&](double col, double row) {
            const double surface = surface_m(col, row);
            return synth::Ray{col - east * surface, row - south * surface, east, south};
        };
        write_gray(path, scene_.size, scene_.bits, options,
                   [&](const Rect& part, ImageView<std::uint16_t> out) {
                       renderer_.render(ray, camera, part, out);
                   });
    }

    const synth::Scene& scene_;
    const SceneCameras& cameras_;
    const synth::OverheadRenderer& renderer_;
    geometry::MapProjection map_;
    geometry::ElevationGrid dem_;
};

} // namespace

void write_orthos(const synth::Scene& scene, const SceneCameras& cameras,
                  const synth::OverheadRenderer& renderer, const std::string& folder)
{
    OrthoScene(scene, cameras, renderer).write(folder);
}

} // namespace hsgm::pipeline
