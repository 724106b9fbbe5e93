// Orthoimages and reference DEMs, from a scene with exact truth to a DSM.

#include "tests/end_to_end/raw_place.h"

#include <algorithm>
#include <cmath>

using namespace hsgm::tests;

namespace {

constexpr const char* kScene = R"(
size: [420, 420]
seed: 5
bits: 11
cameras:
  crs: EPSG:32633
  west: 520000 # 20 km off the central meridian: the map's north is not quite true north
  north: 5300000
  cell_m: 0.5
  base_m: 320
  pixel_m: 0.5
  left: {toward_east: 0.14, toward_north: 0.06, turn_deg: 3}
  right: {toward_east: -0.17, toward_north: -0.03, turn_deg: -2, written_col_px: 1.1, written_row_px: -1.7}
  ortho: {ORTHO}
terrain:
  waves:
    - {amplitude_px: 9, wavelength_px: 400, direction_deg: 35}
    - {amplitude_px: 5, wavelength_px: 300, direction_deg: 120}
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

constexpr const char* kOrtho =
    "pair: {left: scene/ortho_left.tif, right: scene/ortho_right.tif}\n"
    "geometry: {kind: ortho, reference_dem: scene/reference_dem.tif}\n"
    "output: {folder: result}\n";

class Place {
public:
    explicit Place(const std::string& ortho = "dem_post_cells: 48")
    {
        std::string scene = kScene;
        scene.replace(scene.find("ORTHO"), 5, ortho);
        put_bytes(folder_ / "scene.yaml", scene);
        put_bytes(folder_ / "ortho.yaml", kOrtho);
        put_bytes(folder_ / "rpc.yaml", kRawRun);
        hsgm_does({"synth", folder_ / "scene.yaml", "-o", folder_ / "scene"});
    }
    std::string operator/(const std::string& name) const { return folder_ / name; }

    Outcome run(const std::string& config, const std::string& result,
                const std::vector<std::string>& settings = {}) const
    {
        std::vector<std::string> words{
            "run", folder_ / config, "-o", folder_ / result, "--threads", "2"};
        for (const std::string& setting : settings) {
            words.insert(words.end(), {"--set", setting});
        }
        return run_hsgm(words);
    }
    json score(const std::string& result) const
    {
        return score_of(folder_ / (result + "/dsm.tif"), folder_ / "scene");
    }

private:
    TemporaryFolder folder_;
};

void check_good(const json& score)
{
    CAPTURE(score.dump(1));
    CHECK(score["completeness_percent"] > 93);
    CHECK(score["within"][1]["percent"] > 91);
    CHECK(score["nmad_m"] < 0.15);
}

/// Orthoimages have no pointing error here, so nothing may be shifted.
void check_in_place(const json& score)
{
    CAPTURE(score.dump(1));
    CHECK(std::abs(score["shift"]["east_m"].get<double>()) < 0.1);
    CHECK(std::abs(score["shift"]["north_m"].get<double>()) < 0.1);
    CHECK(std::abs(score["shift"]["up_m"].get<double>()) < 0.1);
}

int span_of(const json& info)
{
    const std::string range = info["metadata"][""]["HSGM_DISPARITY"];
    const auto dots = range.find("..");
    return std::stoi(range.substr(dots + 2)) - std::stoi(range.substr(0, dots));
}

void gdal(const std::vector<std::string>& command)
{
    const Outcome outcome = run_program(command);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
}

} // namespace

TEST_CASE("two orthoimages on a DEM become a DSM, the same for every tiling")
{
    const Place place;
    const Outcome first = place.run("ortho.yaml", "result", {"run.tile_size=0"});
    INFO(first.err);
    REQUIRE(first.code == 0);
    CHECK(first.err.find("does not say what its heights count from") != std::string::npos);
    check_good(place.score("result"));
    check_in_place(place.score("result"));
    // Other tiles, and the geometry from the earlier run.
    REQUIRE(place
                .run("ortho.yaml", "again",
                     {"run.tile_size=100", "geometry.stored=" + place / "result/geometry.json"})
                .code == 0);
    const Snapshot result = snapshot(place / "result");
    const Snapshot again = snapshot(place / "again");
    for (const char* file : {"disparity.tif", "reasons.tif", "residual.tif", "dsm.tif",
                             "dsm.confidence.tif", "hillshade.tif", "geometry.json"}) {
        CAPTURE(file);
        REQUIRE(result.contains(file));
        CHECK(result.at(file) == again.at(file));
    }
    // The raw images' RPCs tell the same rays, but for a pointing error that does not matter.
    REQUIRE(place
                .run("ortho.yaml", "rays",
                     {"pair.left={path: " + place / "scene/ortho_left.tif" +
                          ", rpc: " + place / "scene/left.tif" + "}",
                      "pair.right={path: " + place / "scene/ortho_right.tif" +
                          ", rpc: " + place / "scene/right.tif" + "}"})
                .code == 0);
    check_good(place.score("rays"));
    check_in_place(place.score("rays"));
}

TEST_CASE("how orthoimages were taken is found in an IMD file beside them")
{
    const Place place("plane_m: 310");
    const std::vector<std::string> plane{"geometry.reference_dem=",
                                         "geometry.reference_height_m=310"};
    REQUIRE(place.run("ortho.yaml", "own", plane).code == 0);
    const auto bare = [&](const std::string& side) {
        const std::string image = place / ("scene/ortho_" + side + ".tif");
        const std::string copy = place / (side + ".tif");
        gdal({"gdal_translate", "-q", "-mo", "VIEW_AZIMUTH_DEG=", "-mo",
              "VIEW_INCIDENCE_DEG=", image, copy});
        return copy;
    };
    auto settings = plane;
    settings.push_back("pair={left: " + bare("left") + ", right: " + bare("right") + "}");
    says(place.run("ortho.yaml", "r", settings), 3, "nothing says how the orthoimage");
    for (const char* side : {"left", "right"}) {
        const json own =
            gdalinfo(place / ("scene/ortho_" + std::string(side) + ".tif"))["metadata"][""];
        const double elevation = 90 - std::stod(own["VIEW_INCIDENCE_DEG"].get<std::string>());
        put_bytes(place / (std::string(side) + ".IMD"),
                  "version = \"AA\";\nBEGIN_GROUP = IMAGE_1\n\tsatId = \"WV02\";\n"
                  "\tmeanSatAz = " +
                      own["VIEW_AZIMUTH_DEG"].get<std::string>() + ";\n\tmeanSatEl = " +
                      std::to_string(elevation) + ";\nEND_GROUP = IMAGE_1\nEND;\n");
    }
    const Outcome outcome = place.run("ortho.yaml", "imd", settings);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    // Angles of fewer digits: the same to a hundredth of a metre.
    const json own = place.score("own");
    const json imd = place.score("imd");
    CHECK(std::abs(own["rmse_m"].get<double>() - imd["rmse_m"].get<double>()) < 0.01);
    check_good(imd);
    check_in_place(imd);
}

TEST_CASE("orthoimages may have different bands")
{
    const Place place("plane_m: 310");
    const std::vector<std::string> plane{"geometry.reference_dem=",
                                         "geometry.reference_height_m=310"};
    // The left one's pixels are its fourth band, beside others.
    gdal({"gdal_translate",
          "-q",
          "-b",
          "1",
          "-b",
          "1",
          "-b",
          "1",
          "-b",
          "1",
          "-scale_1",
          "0",
          "4000",
          "4000",
          "0",
          "-scale_2",
          "0",
          "4000",
          "4000",
          "0",
          place / "scene/ortho_left.tif",
          place / "four.tif"});
    auto settings = plane;
    settings.push_back("pair.left={path: " + place / "four.tif" + ", band: 4}");
    const Outcome outcome = place.run("ortho.yaml", "bands", settings);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    REQUIRE(place.run("ortho.yaml", "own", plane).code == 0);
    CHECK(snapshot(place / "bands").at("dsm.tif") == snapshot(place / "own").at("dsm.tif"));
    settings.back() = "pair.left={path: " + place / "four.tif" + ", band: 5}";
    says(place.run("ortho.yaml", "r", settings), 3, "band 5");
}

TEST_CASE("orthoimages may lie on a plane, on grids and maps of their own")
{
    const Place place("plane_m: 310");
    const std::string right = place / "right_degrees.tif";
    gdal({"gdalwarp", "-q", "-t_srs", "EPSG:4326", "-r", "lanczos", "-ot", "Float32",
          "-dstnodata", "0", place / "scene/ortho_right.tif", right});
    const std::vector<std::string> settings{
        "geometry.reference_dem=", "geometry.reference_height_m=310",
        "pair.right={path: " + right + ", nodata: 0}"};
    const Outcome outcome = place.run("ortho.yaml", "plane", settings);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    // The right image was resampled once more.
    const json score = place.score("plane");
    CAPTURE(score.dump(1));
    CHECK(score["completeness_percent"] > 93);
    CHECK(score["within"][1]["percent"] > 90);
    CHECK(score["nmad_m"] < 0.2);
    check_in_place(score);
    // Swapped, with the view as a vector.
    REQUIRE(place
                .run("ortho.yaml", "swapped",
                     {"geometry.reference_dem=", "geometry.reference_height_m=310",
                      "pair.right={path: " + place / "scene/ortho_left.tif" +
                          ", view_vector: [0.14, 0.06]}",
                      "pair.left={path: " + place / "scene/ortho_right.tif" +
                          ", view_vector: [-0.17, -0.03]}"})
                .code == 0);
    check_good(place.score("swapped"));
    check_in_place(place.score("swapped"));
}

TEST_CASE("a reference DEM takes relief out of raw pairs, whatever its map and datum")
{
    const Place place("dem_post_cells: 48, dem_error_m: 1");
    REQUIRE(place.run("rpc.yaml", "level").code == 0);
    // The same DEM in degrees, with heights above the geoid.
    const std::string dem = place / "egm96.tif";
    gdal({"gdalwarp", "-q", "-s_srs", "EPSG:32633", "-t_srs", "EPSG:4326", "-r", "bilinear",
          place / "scene/reference_dem.tif", place / "degrees.tif"});
    gdal({"gdal_translate", "-q", "-scale", "0", "1000", "-45.3", "954.7",
          place / "degrees.tif", dem});
    const Outcome outcome =
        place.run("rpc.yaml", "relief",
                  {"geometry.reference_dem=" + dem, "geometry.reference_dem_vertical=EGM96"});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    check_good(place.score("relief"));
    const int level = span_of(gdalinfo(place / "level/disparity.tif"));
    const int relief = span_of(gdalinfo(place / "relief/disparity.tif"));
    CAPTURE(level, relief);
    CHECK(relief < level - 5);
    // Heights over the DEM given: buildings of 20 m on errors of 1 m, and what it smooths.
    REQUIRE(
        place
            .run("rpc.yaml", "given",
                 {"geometry.reference_dem=" + place / "scene/reference_dem.tif",
                  "geometry.reference_dem_vertical=ellipsoid", "geometry.above_dem_m=[-6, 26]"})
            .code == 0);
    check_good(place.score("given"));
    // A DEM of the western half says so; beyond it the run goes on.
    gdal({"gdal_translate", "-q", "-srcwin", "0", "0", "8", "15",
          place / "scene/reference_dem.tif", place / "half.tif"});
    const Outcome half = place.run("rpc.yaml", "half",
                                   {"geometry.reference_dem=" + place / "half.tif",
                                    "geometry.reference_dem_vertical=ellipsoid"});
    INFO(half.err);
    REQUIRE(half.code == 0);
    CHECK(half.err.find("the reference DEM has heights for ") != std::string::npos);
    check_good(place.score("half"));
}

TEST_CASE("what makes no pair of orthoimages, and what is no DEM, is refused in one sentence")
{
    const Place place;
    const std::string left = place / "scene/ortho_left.tif";
    const std::string dem = "geometry.reference_dem=" + place / "scene/";
    says(place.run("ortho.yaml", "r", {"geometry.reference_dem="}), 2,
         "what the orthoimages were made on must be given");
    says(place.run("ortho.yaml", "r", {"pair.right=" + place / "scene/truth_dsm.tif"}), 3,
         "nothing says how the orthoimage");
    says(place.run("ortho.yaml", "r", {"pair.right=" + place / "scene/right.tif"}), 3,
         "is no orthoimage");
    says(place.run("ortho.yaml", "r", {"pair.right=" + left}), 3, "nearly the same place");
    says(place.run("ortho.yaml", "r",
                   {"pair.right={path: " + left + ", azimuth_deg: 67, incidence_deg: 9.2}"}),
         3, "nearly the same place");
    says(place.run("ortho.yaml", "r", {"pair.left={path: " + left + ", azimuth_deg: 3}"}), 2,
         "give azimuth_deg and incidence_deg");
    says(place.run("ortho.yaml", "r",
                   {"pair.left={path: " + left +
                    ", azimuth_deg: 3, incidence_deg: 4, view_vector: [0, 1]}"}),
         2, "say the same");
    says(place.run("rpc.yaml", "r", {"pair.left={path: " + left + ", view_vector: [0, 1]}"}), 2,
         "is for geometry kind ortho only");
    says(place.run("ortho.yaml", "r", {"geometry.heights_m=[100, 400]"}), 2,
         "give above_dem_m");
    says(place.run("ortho.yaml", "r", {"geometry.above_dem_m=[9, 1]"}), 2,
         "'geometry.above_dem_m' is [9, 1]");
    says(place.run("rpc.yaml", "r", {"geometry.above_dem_m=[0, 9]"}), 2,
         "has no meaning without reference_dem");
    says(place.run("ortho.yaml", "r", {"geometry.reference_dem_vertical=EGM2008"}), 2,
         "is not installed");
    says(place.run("rpc.yaml", "r", {dem + "left.tif"}), 3, "lies on no map");
    says(place.run("rpc.yaml", "r", {dem + "nothing.tif"}), 3, "nothing.tif");
    // A DEM elsewhere, an orthoimage elsewhere.
    for (const char* name : {"reference_dem", "ortho_right"}) {
        gdal({"gdal_translate", "-q", "-a_ullr", "600000", "5300000", "600210", "5299790",
              place / ("scene/" + std::string(name) + ".tif"),
              place / (std::string(name) + "_away.tif")});
    }
    says(place.run("ortho.yaml", "r",
                   {"geometry.reference_dem=" + place / "reference_dem_away.tif"}),
         3, "has no height where the images lie");
    says(place.run("ortho.yaml", "r", {"pair.right=" + place / "ortho_right_away.tif"}), 3,
         "the images do not overlap");
    // A vertical datum that only the file names, and whose grid is missing.
    gdal({"gdal_translate", "-q", "-a_srs", "EPSG:32633+3855",
          place / "scene/reference_dem.tif", place / "egm2008.tif"});
    says(place.run("ortho.yaml", "r", {"geometry.reference_dem=" + place / "egm2008.tif"}), 2,
         "egm2008.tif cannot be turned into heights above the ellipsoid");
    CHECK_FALSE(std::filesystem::exists(place / "r"));
}
