#include "pipeline/stages/scene_cameras.h"

#include "pipeline/geometry/map_projection.h"
#include "pipeline/geometry/rpc_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace hsgm::pipeline {

namespace {

void require(bool allowed, const char* key, double value, const char* what)
{
    if (!allowed) {
        throw std::invalid_argument(
            fmt::format("cameras.{} is {}; allowed: {}", key, value, what));
    }
}

void validate_view(const OrbitView& view, const std::string& name)
{
    const auto check = [&](double value, const char* key, double most) {
        if (!(std::abs(value) <= most)) {
            throw std::invalid_argument(fmt::format("cameras.{}.{} is {}; allowed: {} to {}",
                                                    name, key, value, -most, most));
        }
    };
    check(view.toward_east, "toward_east", 1);
    check(view.toward_north, "toward_north", 1);
    check(view.turn_deg, "turn_deg", 360);
    check(view.written_col_px, "written_col_px", 100);
    check(view.written_row_px, "written_row_px", 100);
}

} // namespace

void SceneCameras::validate() const
{
    require(std::isfinite(west), "west", west, "a number");
    require(std::isfinite(north), "north", north, "a number");
    require(cell_m >= 0.05 && cell_m <= 100, "cell_m", cell_m, "0.05 to 100");
    require(pixel_m >= 0.05 && pixel_m <= 100, "pixel_m", pixel_m, "0.05 to 100");
    require(base_m >= -500 && base_m <= 9000, "base_m", base_m, "-500 to 9000");
    validate_view(left, "left");
    validate_view(right, "right");
    if (ortho) {
        require(ortho->dem_post_cells >= 16 && ortho->dem_post_cells <= 1024 &&
                    ortho->dem_post_cells % 16 == 0,
                "ortho.dem_post_cells", ortho->dem_post_cells,
                "whole multiples of 16, from 16 to 1024");
        require(ortho->dem_error_m >= 0 && ortho->dem_error_m <= 100, "ortho.dem_error_m",
                ortho->dem_error_m, "0 to 100");
        require(!ortho->plane_m || (*ortho->plane_m >= -500 && *ortho->plane_m <= 9000),
                "ortho.plane_m", ortho->plane_m.value_or(0), "-500 to 9000");
    }
}

OrbitCamera::OrbitCamera(const SceneCameras& cameras, const OrbitView& view, tiling::Size map,
                         const synth::DisparityBounds& heights_m)
    : cameras_(cameras), view_(view), map_(map), heights_m_(heights_m),
      cos_turn_(synth::cosine_of_turns(view.turn_deg / 360)),
      sin_turn_(synth::sine_of_turns(view.turn_deg / 360))
{
    double least_col = 1e300;
    double most_col = -1e300;
    double least_row = 1e300;
    double most_row = -1e300;
    for (const double x : {-0.5, map.cols - 0.5}) {
        for (const double y : {-0.5, map.rows - 0.5}) {
            for (const double height_m : {heights_m.min_px, heights_m.max_px}) {
                const geometry::ImagePoint p = project(x, y, height_m);
                least_col = std::min(least_col, p.x);
                most_col = std::max(most_col, p.x);
                least_row = std::min(least_row, p.y);
                most_row = std::max(most_row, p.y);
            }
        }
    }
    col_shift_ = -std::floor(least_col);
    row_shift_ = -std::floor(least_row);
    size_ = {static_cast<int>(std::ceil(most_row) + row_shift_) + 1,
             static_cast<int>(std::ceil(most_col) + col_shift_) + 1};
}

// Along the line of sight to the base, then turned and scaled.
geometry::ImagePoint OrbitCamera::project(double x, double y, double height_m) const
{
    const double east_m = x * cameras_.cell_m - view_.toward_east * height_m;
    const double south_m = y * cameras_.cell_m + view_.toward_north * height_m;
    return {(cos_turn_ * east_m + sin_turn_ * south_m) / cameras_.pixel_m + col_shift_,
            (cos_turn_ * south_m - sin_turn_ * east_m) / cameras_.pixel_m + row_shift_};
}

synth::Ray OrbitCamera::ray(double col, double row) const
{
    const double u_m = (col - col_shift_) * cameras_.pixel_m;
    const double v_m = (row - row_shift_) * cameras_.pixel_m;
    return {(cos_turn_ * u_m - sin_turn_ * v_m) / cameras_.cell_m,
            (cos_turn_ * v_m + sin_turn_ * u_m) / cameras_.cell_m,
            view_.toward_east / cameras_.cell_m, -view_.toward_north / cameras_.cell_m};
}

synth::Ray OrbitCamera::ray_through(double x, double y, double height_m) const
{
    const synth::Ray leaning{0, 0, view_.toward_east / cameras_.cell_m,
                             -view_.toward_north / cameras_.cell_m};
    return {x - leaning.x_at(height_m), y - leaning.y_at(height_m), leaning.x_per_m,
            leaning.y_per_m};
}

geometry::RpcModel OrbitCamera::model() const
{
    constexpr int kPlaces = 9; // along each axis of the map
    constexpr int kHeights = 5;
    const auto map = geometry::MapProjection::from_text(cameras_.crs);
    if (!map.in_metres()) {
        throw std::invalid_argument("cameras.crs is " + map.name() +
                                    "; allowed: a map in metres, such as a UTM zone");
    }
    // Beyond the scene, so that its rim and made-up heights are no extrapolation.
    const double low_m = heights_m_.min_px - 100;
    const double high_m = heights_m_.max_px + 100;
    std::vector<geometry::GeodeticPoint> ground;
    std::vector<geometry::ImagePoint> image;
    for (int i = 0; i < kPlaces * kPlaces * kHeights; ++i) {
        const double x = map_.cols * (i % kPlaces * 1.2 / (kPlaces - 1) - 0.1);
        const double y = map_.rows * (i / kPlaces % kPlaces * 1.2 / (kPlaces - 1) - 0.1);
        const double height_m =
            low_m + (high_m - low_m) * (i / (kPlaces * kPlaces)) / (kHeights - 1);
        ground.push_back(map.inverse({cameras_.west + (x + 0.5) * cameras_.cell_m,
                                      cameras_.north - (y + 0.5) * cameras_.cell_m,
                                      cameras_.base_m + height_m}));
        image.push_back(project(x, y, height_m));
    }
    const geometry::RpcModel model = geometry::fit_rpc(ground, image);
    const geometry::RpcCamera camera(model);
    constexpr double kTrue_px = 1e-4;
    for (std::size_t i = 0; i < ground.size(); ++i) {
        const geometry::ImagePoint p = camera.project(ground[i]);
        if (!(std::hypot(p.x - image[i].x, p.y - image[i].y) <= kTrue_px)) {
            throw std::invalid_argument(
                "a map of this size is more than one rational model can hold to 0.0001 px; "
                "make size or cameras.cell_m smaller");
        }
    }
    return model;
}

geometry::RpcModel OrbitCamera::written_model() const
{
    geometry::RpcModel written = model();
    written.samp_off += view_.written_col_px;
    written.line_off += view_.written_row_px;
    return written;
}

} // namespace hsgm::pipeline
