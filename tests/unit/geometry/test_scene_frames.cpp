// Epipolar frames of real images and of whole scenes of real models: rows follow the parallax
// over all of their ground and heights.

#include "io/rpc_metadata.h"
#include "pipeline/geometry/epipolar_frame.h"
#include "pipeline/stages/camera_stage.h"
#include "tests/unit/geometry/data_folder.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

using namespace hsgm;
using namespace hsgm::geometry;

namespace {

struct Picture {
    RpcCamera camera;
    tiling::Size size;
};

Picture picture(const std::string& image, const std::string& rpc = "")
{
    const io::RasterSource source({samples::data_folder() + "/" + image});
    const std::string file = rpc.empty() ? "" : samples::data_folder() + "/" + rpc;
    return {pipeline::open_camera(source, file), source.size()};
}

// A whole scene, of which only the model is at hand; its offsets are the middle.
Picture scene(const std::string& model)
{
    const RpcModel m = pipeline::to_model(
        io::read_rpc_file(samples::data_folder() + "/../geometry_rpc/" + model + "_RPC.txt"));
    return {RpcCamera(m), {static_cast<int>(2 * m.line_off), static_cast<int>(2 * m.samp_off)}};
}

bool inside(ImagePoint p, tiling::Size size)
{
    return p.x >= 0 && p.y >= 0 && p.x <= size.cols - 1 && p.y <= size.rows - 1;
}

void check(const std::string& name, const Picture& left, const Picture& right, double level_m,
           double below_m, double above_m)
{
    const auto middle =
        left.camera.locate({left.size.cols / 2.0, left.size.rows / 2.0}, level_m);
    REQUIRE(middle.has_value());
    const MapProjection map =
        MapProjection::automatic(middle->longitude_deg, middle->latitude_deg);
    const RpcGroundCamera a(left.camera, map);
    const RpcGroundCamera b(right.camera, map);
    const ReferenceSurface surface(level_m);
    FrameOptions options;
    options.below_m = below_m;
    options.above_m = above_m;
    const EpipolarFrame frame =
        make_epipolar_frame(a, left.size, b, right.size, surface, options);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    double squares = 0;
    double most = 0;
    int points = 0;
    for (int i = 0; i < 5000; ++i) {
        const FramePoint at{unit(random) * frame.size.rows, unit(random) * frame.size.cols};
        const double height = level_m + below_m + unit(random) * (above_m - below_m);
        const auto place = a.locate(frame.left_at(at), height);
        REQUIRE(place.has_value());
        const ImagePoint seen = b.project(*place);
        if (!inside(frame.left_at(at), left.size) || !inside(seen, right.size)) {
            continue;
        }
        const auto foot = b.locate(seen, level_m);
        const auto there = frame.frame_at(foot->x, foot->y);
        REQUIRE(there.has_value());
        squares += std::pow(at.row - there->row, 2);
        most = std::max(most, std::abs(at.row - there->row));
        ++points;
    }
    REQUIRE(points > 1000);
    const double rms = std::sqrt(squares / points);
    std::cout << name << ": " << frame.size.cols << " x " << frame.size.rows << " px, gsd "
              << frame.gsd_m << " m, " << frame.px_per_m << " px/m; row parallax " << rms
              << " px rms, " << most << " px at most\n";
    CAPTURE(name);
    CHECK(rms < 0.01); // the promise is 0.1
    CHECK(most < 0.1);
    CHECK(frame.lattice_error_px < 0.005);
}

} // namespace

TEST_CASE("rows follow the parallax of every pair of images at hand")
{
    if (!samples::has_data("sat_reunion_pair")) {
        return;
    }
    check("Reunion", picture("sat_reunion_pair/img_01.tif"),
          picture("sat_reunion_pair/img_02.tif"), 2330, -100, 100);
    check("synthetic", picture("synthetic_satellite_500m/left.tif"),
          picture("synthetic_satellite_500m/right.tif"), 60, -30, 90);
    check("Gizeh", picture("sat_gizeh_phr/img1.tif", "sat_gizeh_phr/img1.geom"),
          picture("sat_gizeh_phr/img2.tif", "sat_gizeh_phr/img2.geom"), 77, -30, 150);
    check("Kahramanmaras",
          picture("sat_kahramanmaras_pre/img1.tif", "sat_kahramanmaras_pre/img1.geom"),
          picture("sat_kahramanmaras_pre/img2.tif", "sat_kahramanmaras_pre/img2.geom"), 700,
          -200, 100);
}

TEST_CASE("rows follow the parallax of whole scenes of 20 km")
{
    if (!samples::has_data("../geometry_rpc")) {
        return;
    }
    check("Reunion, whole", scene("s2p_pair_1"), scene("s2p_pair_2"), 1300, -1000, 1000);
    check("Gizeh, whole", scene("gizeh_1"), scene("gizeh_2"), 77, -100, 100);
    check("Ventoux, whole", scene("ventoux_left"), scene("ventoux_right"), 1000, -800, 900);
    check("Marseille, whole", scene("s2p_triplet_1"), scene("s2p_triplet_2"), 565, -500, 500);
    check("WorldView-3, whole", scene("wv3_20"), scene("wv3_30"), 100, -100, 200);
}
