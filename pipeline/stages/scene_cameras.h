#pragma once

#include "pipeline/geometry/rpc_camera.h"
#include "pipeline/synth/ray_caster.h"
#include "pipeline/synth/terrain.h"
#include "tiling/rect.h"

#include <optional>
#include <string>

namespace hsgm::pipeline {

/// How one image of a scene is taken: from so far away that all its lines of sight are
/// parallel on the map.
struct OrbitView {
    double toward_east = 0;  ///< metres towards the camera per metre up, -1..1: the tangent of
    double toward_north = 0; ///< its angle off nadir, in east and north
    double turn_deg = 0;     ///< of the image, clockwise; 0: rows run east
    double written_col_px = 0; ///< what the written model adds to true image positions:
    double written_row_px = 0; ///< a pointing error

    bool operator==(const OrbitView&) const = default;
};

/// Orthoimages to be made of a scene beside its raw images.
struct SceneOrtho {
    std::optional<double> plane_m; ///< above the ellipsoid: made on this plane; else on the DEM
    int dem_post_cells = 48;       ///< between the DEM's posts; whole multiples of 16
    double dem_error_m = 3;        ///< each post is off by up to so much

    bool operator==(const SceneOrtho&) const = default;
};

/// A scene on the map, seen by two cameras on orbit. Cells of the map take the place of the
/// left image's pixels, metres of height above the base that of disparities.
struct SceneCameras {
    std::string crs = "EPSG:32633";
    double west = 500'000; ///< the map's upper left corner
    double north = 5'300'000;
    double cell_m = 0.5;
    double base_m = 200; ///< height above the ellipsoid that the scene's heights start from
    double pixel_m = 0.5;
    OrbitView left{0.15, 0.05, 0, 0, 0};
    OrbitView right{-0.15, -0.02, 0, 0, 0};
    std::optional<SceneOrtho> ortho;

    /// Throws std::invalid_argument naming the key, its value and what is allowed.
    void validate() const;
};

/// One camera over a map of `map` cells whose heights lie within `heights_m` of the base. Its
/// image just holds the whole map.
class OrbitCamera {
public:
    OrbitCamera(const SceneCameras& cameras, const OrbitView& view, tiling::Size map,
                const synth::DisparityBounds& heights_m);

    tiling::Size image_size() const { return size_; }
    /// Lines of sight, in cells and metres above the base.
    synth::Ray ray(double col, double row) const;
    synth::Ray ray_through(double x, double y, double height_m) const;
    /// Where the image shows a place, column and row.
    geometry::ImagePoint project(double x, double y, double height_m) const;
    /// The model of the true camera, found by fitting, true to 1e-4 px; throws
    /// std::invalid_argument for a map too large for that, and for an unknown CRS.
    geometry::RpcModel model() const;
    /// That with the view's pointing error.
    geometry::RpcModel written_model() const;

private:
    SceneCameras cameras_;
    OrbitView view_;
    tiling::Size map_;
    synth::DisparityBounds heights_m_;
    tiling::Size size_;
    double cos_turn_ = 1;
    double sin_turn_ = 0;
    double col_shift_ = 0;
    double row_shift_ = 0;
};

} // namespace hsgm::pipeline
