#include "tests/end_to_end/pairs.h"
#include "tests/end_to_end/rasters.h"

#include <cmath>
#include <cstdlib>

using namespace hsgm::tests;
using nlohmann::json;

// Real pairs from the data folder: environment variable HSGM_DATA_DIR, or beside the sources.
namespace {

std::string data_folder()
{
    const char* named = std::getenv("HSGM_DATA_DIR");
    return named != nullptr ? named : HSGM_DEFAULT_DATA_DIR;
}

bool has_data(const std::string& scene)
{
    if (std::filesystem::exists(data_folder() + "/" + scene)) {
        return true;
    }
    WARN("SKIPPED: no test data in " + data_folder() + "/" + scene + "; see HSGM_DATA_DIR");
    return false;
}

} // namespace

TEST_CASE("Cones, all pixels answered, has at most 3.7 % of errors above 1 px")
{
    if (!has_data("middlebury_cones")) {
        return;
    }
    const TemporaryFolder folder;
    const std::string scene = data_folder() + "/middlebury_cones/";
    hsgm_does({"match", scene + "left.png", scene + "right.png", "-o", folder / "d.tif",
               "--disparity", "0,63", "--set", "matcher.left_right_px=off", "--set",
               "matcher.speckle_px=off", "--set", "matcher.subpixel=sums", "--set",
               "matcher.min_confidence=0", "--set", "matcher.median=off"});
    const json score = json::parse(
        hsgm_does({"evaluate", "disparity", folder / "d.tif", scene + "disp_left_x4.png",
                   "--scale", "4", "--mask", scene + "mask_nonocc.png", "--mask-value", "255",
                   "--thresholds", "1", "--json"})
            .out);
    CHECK(score["bad"][0]["bad_percent"] <= 3.7);
}

TEST_CASE("a satellite pair with negative disparities is run and scored at 3 px")
{
    if (!has_data("sat_us3d_JAX_079_006_007")) {
        return;
    }
    const TemporaryFolder folder;
    const std::string scene = data_folder() + "/sat_us3d_JAX_079_006_007/";
    put_bytes(folder / "run.yaml", "pair: {left: '" + scene + "left.png', right: '" + scene +
                                       "right.png'}\n"
                                       "geometry: {kind: rectified}\n"
                                       "output: {folder: result}\n"
                                       "matcher: {disparity: [-64, 64]}\n");
    hsgm_does({"run", folder / "run.yaml"});
    const json score =
        json::parse(hsgm_does({"evaluate", "disparity", folder / "result/disparity.tif",
                               scene + "disp_left.tif", "--truth-nodata", "-999",
                               "--nonoccluded", "zbuffer", "--thresholds", "3", "--json"})
                        .out);
    CHECK(score["evaluated_pixels"] > 700000);
    CHECK(score["density_percent"] > 80);
    CHECK(score["bad"][0]["bad_answered_percent"] < 9);
}

TEST_CASE("orthoimages of a scene give as good a DSM as its raw images")
{
    if (!has_data("synthetic_satellite_500m")) {
        return;
    }
    const TemporaryFolder folder;
    const std::string scene = data_folder() + "/synthetic_satellite_500m/";
    put_bytes(folder / "rpc.yaml",
              "pair: {left: '" + scene + "left.tif', right: '" + scene +
                  "right.tif'}\ngeometry: {kind: rpc}\noutput: {folder: rpc}\n");
    put_bytes(folder / "ortho.yaml",
              "pair:\n  left: {path: '" + scene +
                  "ortho_left.tif', view_vector: [-0.0766602, 0.1725125]}\n  right: {path: '" +
                  scene + "ortho_right.tif', view_vector: [-0.0810479, -0.1343821]}\n" +
                  "geometry: {kind: ortho, reference_dem: '" + scene +
                  "ortho_refdem.tif', reference_dem_vertical: ellipsoid}\n" +
                  "output: {folder: ortho}\n");
    const auto score = [&](const std::string& name) {
        hsgm_does({"run", folder / (name + ".yaml"), "-o", folder / name});
        return json::parse(
            hsgm_does({"evaluate", "dsm", folder / (name + "/dsm.tif"), scene + "truth_dsm.tif",
                       "--mask", scene + "truth_visible.tif", "--mask-bits", "3", "--classes",
                       scene + "truth_classes.tif", "--exclude-classes", "3", "--align-classes",
                       "0", "--json"})
                .out);
    };
    const json rpc = score("rpc");
    const json ortho = score("ortho");
    CAPTURE(rpc.dump(1), ortho.dump(1));
    CHECK(ortho["nmad_m"] <= 1.1 * rpc["nmad_m"].get<double>());
    CHECK(ortho["completeness_percent"] >= 0.9 * rpc["completeness_percent"].get<double>());
    CHECK(ortho["within"][1]["percent"] >= 93);
    // They were made with the true RPCs: nothing is shifted.
    CHECK(std::abs(ortho["shift"]["east_m"].get<double>()) < 0.05);
    CHECK(std::abs(ortho["shift"]["north_m"].get<double>()) < 0.05);
    CHECK(std::abs(ortho["shift"]["up_m"].get<double>()) < 0.05);
}
