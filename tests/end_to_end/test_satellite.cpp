// Raw pairs with RPCs, from a scene with exact truth to a DSM.

#include "tests/end_to_end/raw_place.h"

using namespace hsgm::tests;

namespace {

void check_good(const json& score)
{
    CAPTURE(score.dump(1));
    const json& all = score;
    CHECK(all["completeness_percent"] > 96);
    CHECK(all["within"][1]["percent"] > 93);
    CHECK(all["nmad_m"] < 0.15);
    CHECK(all["rmse_m"] < 0.75);
    CHECK(all["le90_m"] < 0.33);
    // What a pair cannot see of the pointing error moves everything, but not by much.
    CHECK(std::abs(all["shift"]["east_m"].get<double>()) < 1.5);
    CHECK(std::abs(all["shift"]["north_m"].get<double>()) < 1.5);
    CHECK(std::abs(all["shift"]["up_m"].get<double>()) < 6);
}

double mean_of(const std::string& raster)
{
    const auto pixels = pixels_of(raster);
    double sum = 0;
    int count = 0;
    for (const double value : pixels.pixels()) {
        if (!std::isnan(value)) {
            sum += value;
            ++count;
        }
    }
    return sum / count;
}

} // namespace

TEST_CASE("two raw images with RPCs become a DSM, the same for every tiling")
{
    const RawPlace place;
    const Outcome first = place.run("result", {"--tile-size", "0"});
    INFO(first.err);
    REQUIRE(first.code == 0);
    CHECK(first.err.find("pointing mended by ") != std::string::npos);
    check_good(place.score("result"));
    // Other tiles, and the geometry from the earlier run.
    REQUIRE(place
                .run("again", {"--tile-size", "100", "--set",
                               "geometry.stored=" + place / "result/geometry.json"})
                .code == 0);
    const Snapshot result = snapshot(place / "result");
    const Snapshot again = snapshot(place / "again");
    for (const char* file :
         {"disparity.tif", "confidence.tif", "reasons.tif", "height.tif", "residual.tif",
          "dsm.tif", "dsm.confidence.tif", "dsm.points.tif", "dsm.spread.tif",
          "dsm.reasons.tif", "hillshade.tif", "geometry.json"}) {
        CAPTURE(file);
        REQUIRE(result.contains(file));
        CHECK(result.at(file) == again.at(file));
    }
    // Where it lies, in the words of another program.
    const json info = gdalinfo(place / "result/dsm.tif");
    CHECK(info["geoTransform"][1] == 0.5);
    CHECK(info["coordinateSystem"]["wkt"].get<std::string>().find("UTM zone 33N") !=
          std::string::npos);
    CHECK(info["bands"][0]["noDataValue"] == -32768.0);
    CHECK(info["bands"][0]["metadata"][""].contains("STATISTICS_MEAN"));
    CHECK(info["metadata"]["IMAGE_STRUCTURE"]["LAYOUT"] == "COG");
    CHECK(info["metadata"][""]["HSGM_HEIGHTS"] == "height above the WGS84 ellipsoid");
    // Rays meet where the pointing was mended.
    const auto residual = pixels_of(place / "result/residual.tif");
    double worst = 0;
    for (const double value : residual.pixels()) {
        worst = std::isnan(value) ? worst : std::max(worst, value);
    }
    CHECK(worst > 0);
    CHECK(worst < 0.1);
}

TEST_CASE("raw images may be swapped and turned, and maps and datums chosen")
{
    const RawPlace place("178");
    REQUIRE(place.run("turned").code == 0);
    check_good(place.score("turned"));
    REQUIRE(place
                .run("swapped", {"--set", "pair.left=" + place / "scene/right.tif", "--set",
                                 "pair.right=" + place / "scene/left.tif"})
                .code == 0);
    check_good(place.score("swapped"));
    REQUIRE(
        place
            .run("other", {"--set", "dsm.crs=EPSG:32634", "--set", "dsm.vertical=EPSG:5773",
                           "--set", "dsm.gsd_m=2", "--set", "geometry.heights_m=[300, 360]"})
            .code == 0);
    const json info = gdalinfo(place / "other/dsm.tif");
    CHECK(info["geoTransform"][1] == 2.0);
    CHECK(std::fmod(info["geoTransform"][0].get<double>(), 2.0) == 0.0);
    const std::string wkt = info["coordinateSystem"]["wkt"];
    CHECK(wkt.find("UTM zone 34N") != std::string::npos);
    CHECK(wkt.find("EGM96 height") != std::string::npos);
    // At 15 E, 48 N the geoid lies some 45 m above the ellipsoid.
    const double lower = mean_of(place / "turned/dsm.tif") - mean_of(place / "other/dsm.tif");
    CHECK(lower > 42);
    CHECK(lower < 48);
}

TEST_CASE("raw pairs that make no DSM are refused in one sentence")
{
    const RawPlace place;
    const std::string left = place / "scene/left.tif";
    says(place.run("r", {"--set", "pair.right=" + left}), 3, "nearly the same place");
    says(place.run("r", {"--set", "pair.right=" + place / "scene/truth_dsm.tif"}), 3,
         "has no RPC");
    says(place.run("r", {"--set", "geometry.heights_m=[3000, 3100]"}), 3,
         "the images do not overlap: at ");
    says(place.run("r", {"--set", "geometry.heights_m=[5, 1]"}), 2, "'geometry.heights_m' is");
    says(place.run("r", {"--set", "geometry.pointing=off"}), 2, "auto, shift, affine, none");
    says(place.run("r", {"--set", "matcher.disparity=[0, 9]"}), 2,
         "'matcher.disparity' is found by the program");
    says(place.run("r", {"--set", "geometry.height_per_px_m=1"}), 2,
         "'geometry.height_per_px_m' is for geometry kind rectified only");
    says(place.run("r", {"--set", "dsm.crs=EPSG:99"}), 2, "'dsm.crs' cannot be used");
    says(place.run("r", {"--set", "dsm.vertical=EGM2008"}), 2, "is not installed");
    says(place.run("r", {"--set", "geometry.stored=" + place / "scene.yaml"}), 3,
         "the stored geometry cannot be read");
    says(place.run("r", {"--set", "geometry.kind=rectified", "--set",
                         "matcher.disparity=[0, 9]", "--set", "dsm.gsd_m=1"}),
         2, "'dsm.gsd_m' is for geometry kind rpc or ortho only");
    says(
        place.run("r", {"--set", "geometry.kind=rectified", "--set", "matcher.disparity=[0, 9]",
                        "--set", "pair.left={path: scene/left.tif, rpc: x_RPC.TXT}"}),
        2, "'pair.left.rpc' is for geometry kind rpc or ortho only");
    says(place.run("r", {"--set", "pair.left={path: scene/left.tif, rpc: none_RPC.TXT}"}), 3,
         "none_RPC.TXT");
    CHECK_FALSE(std::filesystem::exists(place / "r"));
    // The geometry of other images.
    REQUIRE(place.run("good").code == 0);
    says(place.run("r", {"--set", "geometry.stored=" + place / "good/geometry.json", "--set",
                         "pair.left=" + place / "scene/right.tif"}),
         3, "is the geometry of other images");
}
