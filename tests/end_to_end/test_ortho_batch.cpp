// An archive of orthoimages: what is paired with what, and what is left out.

#include "tests/end_to_end/pairs.h"
#include "tests/end_to_end/rasters.h"

#include <filesystem>

using namespace hsgm::tests;

namespace {

namespace fs = std::filesystem;

constexpr const char* kScene = R"(
size: [300, 300]
seed: 9
bits: 11
cameras:
  west: 500000
  base_m: 320
  left: {toward_east: 0.14, toward_north: 0.06}
  right: {toward_east: -0.17, toward_north: -0.03}
  ortho: {dem_error_m: 1}
terrain:
  waves: [{amplitude_px: 4, wavelength_px: 300, direction_deg: 35}]
  texture: {mean: 0.4, contrast: 0.06, finest_px: 2.5, octaves: 4}
objects:
  - {center_x: 150, center_y: 150, length_px: 60, width_px: 40, height_px: 12}
left: {noise_gray: 5}
right: {noise_gray: 5}
)";

constexpr const char* kConfig =
    "geometry: {kind: ortho, reference_dem: scene/reference_dem.tif}\n"
    "output: {folder: unused}\n";

void gdal(const std::vector<std::string>& command)
{
    const Outcome outcome = run_program(command);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
}

void says(const Outcome& outcome, int code, const std::string& part)
{
    CAPTURE(outcome.err, part);
    CHECK(outcome.code == code);
    CHECK(outcome.err.find(part) != std::string::npos);
}

} // namespace

TEST_CASE("a folder of orthoimages is paired by place and view, and says what is left out")
{
    const TemporaryFolder folder;
    put_bytes(folder / "scene.yaml", kScene);
    put_bytes(folder / "config.yaml", kConfig);
    hsgm_does({"synth", folder / "scene.yaml", "-o", folder / "scene"});
    const std::string archive = folder / "archive";
    fs::create_directory(archive);
    const std::string left = folder / "scene/ortho_left.tif";
    fs::copy(left, archive + "/a.tif");
    gdal({"gdalwarp", "-q", "-nomd", folder / "scene/ortho_right.tif", archive + "/b.tif"});
    gdal({"gdalwarp", "-q", "-nomd", left, archive + "/blind.tif"});
    gdal({"gdal_translate", "-q", "-a_ullr", "600000", "5300000", "600150", "5299850", left,
          archive + "/far.tif"});
    fs::copy(folder / "scene/left.tif", archive + "/raw.tif");
    put_bytes(archive + "/notes.md", "no image\n");
    const auto batch = [&](const std::string& result) {
        return run_hsgm(
            {"batch", archive, "-c", folder / "config.yaml", "-o", folder / result});
    };
    // Without what views.csv says of b, nothing goes with a.
    says(batch("r"), 2, "holds no two orthoimages that make a pair");
    put_bytes(archive + "/views.csv", "image,angle\nb.tif,3\n");
    says(batch("r"), 2, "there is no column 'angle'");
    put_bytes(archive + "/views.csv", "image,azimuth_deg\nb.tif,3\n");
    says(batch("r"), 2, "must have azimuth_deg and incidence_deg, or neither");
    put_bytes(archive + "/views.csv", "image,rpc\nnowhere.tif,3\n");
    says(batch("r"), 2, "there is no nowhere.tif");
    put_bytes(archive + "/views.csv", "image,azimuth_deg,incidence_deg\nb.tif,x,9\n");
    says(batch("r"), 2, "is 'x'; it must be a number");
    // -0.17 east, -0.03 north
    put_bytes(archive + "/views.csv", "image,azimuth_deg,incidence_deg\nb.tif,259.99,9.794\n");
    const Outcome done = batch("result");
    INFO(done.err);
    REQUIRE(done.code == 0);
    CHECK(fs::exists(folder / "result/a-b/dsm.tif"));
    const Snapshot result = snapshot(folder / "result");
    const std::string unpaired = result.at("unpaired.csv");
    CAPTURE(unpaired);
    CHECK(unpaired.find("nothing says how the orthoimage") != std::string::npos);
    CHECK(unpaired.find("overlaps no other image") != std::string::npos);
    CHECK(unpaired.find("raw.tif") != std::string::npos);
    CHECK(unpaired.find("/a.tif") == std::string::npos);
    const std::string summary = result.at("summary.csv");
    CAPTURE(summary);
    CHECK(summary.find("a-b,done,0") != std::string::npos);
    CHECK(summary.find("blind") == std::string::npos);
    // The same view as a's: it could only go with b, and does.
    put_bytes(archive + "/views.csv", "image,azimuth_deg,incidence_deg\nb.tif,66.8,8.66\n");
    const Outcome same = batch("r");
    says(same, 2, "holds no two orthoimages that make a pair");
    CHECK(same.err.find("was taken from nearly the same place as") != std::string::npos);
}
