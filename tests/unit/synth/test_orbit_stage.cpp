#include "tests/catch.h"

#include "io/error.h"
#include "io/raster_source.h"
#include "io/rpc_metadata.h"
#include "pipeline/geometry/map_projection.h"
#include "pipeline/stages/scene_cameras.h"
#include "pipeline/stages/synth_orbit_stage.h"

#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>

using namespace hsgm;
using namespace hsgm::pipeline;

namespace {

const synth::DisparityBounds kHeights{-5, 60};
constexpr tiling::Size kMap{800, 1200};

SceneCameras turned()
{
    SceneCameras cameras;
    cameras.left = {0.3, -0.2, 25, 0, 0};
    cameras.right = {-0.25, 0.1, 180, 1.5, -2.5};
    return cameras;
}

} // namespace

TEST_CASE("an orbit camera's rays and projections are each other's inverse")
{
    const SceneCameras cameras = turned();
    for (const OrbitView& view : {cameras.left, cameras.right}) {
        const OrbitCamera camera(cameras, view, kMap, kHeights);
        for (const double height_m : {-5.0, 0.0, 60.0}) {
            const synth::Ray ray = camera.ray(100.25, 333.5);
            const auto p = camera.project(ray.x_at(height_m), ray.y_at(height_m), height_m);
            CHECK(p.x == Approx(100.25).margin(1e-9));
            CHECK(p.y == Approx(333.5).margin(1e-9));
        }
        const synth::Ray through = camera.ray_through(20, 30, 40);
        CHECK(through.x_at(40) == Approx(20));
        CHECK(through.y_at(40) == Approx(30));
        const auto a = camera.project(20, 30, 40);
        const auto b = camera.project(through.x_at(7), through.y_at(7), 7);
        CHECK(b.x == Approx(a.x));
        CHECK(b.y == Approx(a.y));
    }
}

TEST_CASE("an orbit camera's image holds the whole map at every height")
{
    const OrbitCamera camera(turned(), turned().left, kMap, kHeights);
    for (const double x : {-0.5, 1199.5}) {
        for (const double y : {-0.5, 799.5}) {
            for (const double height_m : {-5.0, 60.0}) {
                const auto p = camera.project(x, y, height_m);
                CHECK(p.x >= 0);
                CHECK(p.y >= 0);
                CHECK(p.x <= camera.image_size().cols - 1);
                CHECK(p.y <= camera.image_size().rows - 1);
            }
        }
    }
}

TEST_CASE(
    "an orbit camera's rational model is the camera, and the written one off by its error")
{
    const SceneCameras cameras = turned();
    const OrbitCamera camera(cameras, cameras.right, kMap, kHeights);
    const auto map = geometry::MapProjection::from_text(cameras.crs);
    const geometry::RpcCamera model(camera.model());
    const geometry::RpcCamera written(camera.written_model());
    for (const double x : {3.0, 777.0}) {
        for (const double height_m : {0.0, 33.0}) {
            const auto ground = map.inverse({cameras.west + (x + 0.5) * cameras.cell_m,
                                             cameras.north - 100.5 * cameras.cell_m,
                                             cameras.base_m + height_m});
            const auto truth = camera.project(x, 100, height_m);
            CHECK(model.project(ground).x == Approx(truth.x).margin(1e-4));
            CHECK(model.project(ground).y == Approx(truth.y).margin(1e-4));
            CHECK(written.project(ground).x == Approx(truth.x + 1.5).margin(1e-4));
            CHECK(written.project(ground).y == Approx(truth.y - 2.5).margin(1e-4));
        }
    }
}

TEST_CASE("cameras that cannot be are refused by key")
{
    SceneCameras cameras;
    cameras.left.toward_east = 1.5;
    CHECK_THROWS_WITH(cameras.validate(), "cameras.left.toward_east is 1.5; allowed: -1 to 1");
    cameras = {};
    cameras.cell_m = 0;
    CHECK_THROWS_WITH(cameras.validate(), "cameras.cell_m is 0; allowed: 0.05 to 100");
    cameras = {};
    cameras.crs = "EPSG:4326";
    CHECK_THROWS_WITH(OrbitCamera(cameras, cameras.left, kMap, kHeights).model(),
                      Catch::Contains("a map in metres"));
    cameras.crs = "EPSG:32633";
    CHECK_THROWS_WITH(OrbitCamera(cameras, cameras.left, {400'000, 400'000}, kHeights).model(),
                      Catch::Contains("one rational model"));
}

TEST_CASE("a scene from orbit is written with models, map and truth")
{
    const std::string folder =
        (std::filesystem::temp_directory_path() / ("hsgm_orbit_" + std::to_string(::getpid())))
            .string();
    synth::Scene scene;
    scene.size = {60, 80};
    scene.bits = 11;
    scene.city = synth::City{};
    const SceneCameras cameras = turned();
    const OrbitSceneSummary summary = write_orbit_scene(scene, cameras, folder);
    io::RasterSource left(io::ImageSpec{folder + "/left.tif"});
    CHECK(left.size() == summary.left);
    CHECK(left.pixel_type() == io::PixelType::uint16);
    const auto rpc = io::stored_rpc(left);
    REQUIRE(rpc.has_value());
    const OrbitCamera camera(
        cameras, cameras.left, scene.size,
        {summary.lowest_m - cameras.base_m, summary.highest_m - cameras.base_m});
    const geometry::RpcModel written = camera.written_model();
    CHECK(rpc->samp_off == Approx(written.samp_off).epsilon(1e-13)); // GDAL gives 15 digits
    for (std::size_t i = 0; i < 20; ++i) {
        CHECK(rpc->line_num[i] == Approx(written.line_num[i]).epsilon(1e-13));
    }
    io::RasterSource dsm(io::ImageSpec{folder + "/truth_dsm.tif"});
    CHECK(dsm.size() == scene.size);
    CHECK(dsm.geo_reference().transform.value()[0] == cameras.west);
    tiling::Image<double> heights(scene.size);
    dsm.read(rect_of(scene.size), heights.view());
    for (const double height_m : heights.pixels()) {
        CHECK(height_m >= summary.lowest_m - 0.01);
        CHECK(height_m <= summary.highest_m + 0.01);
    }
    std::filesystem::remove_all(folder);
}
