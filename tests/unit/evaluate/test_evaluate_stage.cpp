#include "tests/catch.h"

#include "io/error.h"
#include "io/geotiff_writer.h"
#include "pipeline/stages/evaluate_stage.h"
#include "pipeline/stages/synth_stage.h"

#include <tbb/global_control.h>

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

using namespace hsgm;
using namespace hsgm::pipeline;

namespace {

struct TemporaryFolder {
    std::string path = (std::filesystem::temp_directory_path() /
                        ("hsgm_evaluate_" + std::to_string(::getpid())))
                           .string();
    TemporaryFolder() { std::filesystem::create_directories(path); }
    ~TemporaryFolder() { std::filesystem::remove_all(path); }
    std::string operator/(const std::string& name) const { return path + "/" + name; }
};

template <typename T>
void write(const std::string& path, tiling::Size size, std::vector<T> values)
{
    io::GeoTiffWriter writer(path, size, io::pixel_type_of<T>());
    writer.write<T>(tiling::rect_of(size), {values.data(), size, size.cols});
    writer.finish();
}

std::string bytes_of_file(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

synth::Scene little_city()
{
    synth::Scene scene;
    scene.size = {300, 400};
    scene.terrain.offset_px = 3;
    scene.city = synth::City{};
    scene.left.noise_gray = 2;
    return scene;
}

} // namespace

TEST_CASE("zero is unknown in integer truth, unless another value is named")
{
    const TemporaryFolder folder;
    write<float>(folder / "test.tif", {1, 4}, {1, 2, 3, 4});
    write<std::uint8_t>(folder / "truth.tif", {1, 4}, {2, 4, 0, 4});
    DisparityInputs inputs;
    inputs.test = folder / "test.tif";
    inputs.truth = folder / "truth.tif";
    inputs.truth_scale = 2; // 1, 2, unknown, 2
    CHECK(score_disparity(inputs, {1}).evaluated == 3);
    CHECK(score_disparity(inputs, {1}).bad[0].bad_percent == Approx(100.0 / 3));
    inputs.truth_nodata = std::numeric_limits<double>::quiet_NaN();
    CHECK(score_disparity(inputs, {1}).evaluated == 4);
    inputs.truth_nodata = 4;
    CHECK(score_disparity(inputs, {1}).evaluated == 2);
}

TEST_CASE("masks count by value, or by not being zero")
{
    const TemporaryFolder folder;
    write<float>(folder / "map.tif", {1, 4}, {1, 2, 3, 4});
    write<std::uint8_t>(folder / "mask.tif", {1, 4}, {0, 128, 255, 255});
    DisparityInputs inputs;
    inputs.test = inputs.truth = folder / "map.tif";
    inputs.mask = folder / "mask.tif";
    CHECK(score_disparity(inputs, {1}).evaluated == 3);
    inputs.mask_value = 255;
    CHECK(score_disparity(inputs, {1}).evaluated == 2);
}

TEST_CASE("a confidence is scored beside its map, and named where it is none")
{
    const TemporaryFolder folder;
    write<float>(folder / "test.tif", {1, 4}, {1, 2, 3, 9});
    write<float>(folder / "truth.tif", {1, 4}, {1, 2, 3, 4});
    write<std::uint8_t>(folder / "confidence.tif", {1, 4}, {200, 200, 200, 20});
    write<float>(folder / "wild.tif", {1, 4}, {200, 300, 200, 20});
    DisparityInputs inputs;
    inputs.test = folder / "test.tif";
    inputs.truth = folder / "truth.tif";
    CHECK_THROWS_AS(score_confidence(inputs, 1), io::ConfigError);
    inputs.confidence = folder / "confidence.tif";
    const evaluate::ConfidenceScore score = score_confidence(inputs, 1);
    REQUIRE(score.curve.size() == 5);
    CHECK(score.curve[0].bad_percent == Approx(25));
    CHECK(score.curve[3].dropped_percent == 30);
    CHECK(score.curve[3].bad_percent == Approx(0).margin(1e-9));
    inputs.confidence = folder / "wild.tif";
    CHECK_THROWS_WITH(score_confidence(inputs, 1),
                      Catch::Contains("wild.tif") && Catch::Contains("300"));
    CHECK_THROWS_AS(score_confidence(inputs, 1), io::InputError);
}

TEST_CASE("rasters of different sizes are refused by name")
{
    const TemporaryFolder folder;
    write<float>(folder / "test.tif", {1, 4}, {1, 2, 3, 4});
    write<float>(folder / "truth.tif", {2, 2}, {1, 2, 3, 4});
    DisparityInputs inputs;
    inputs.test = folder / "test.tif";
    inputs.truth = folder / "truth.tif";
    CHECK_THROWS_WITH(score_disparity(inputs, {1}),
                      Catch::Contains("truth.tif") && Catch::Contains("2 rows x 2 columns"));
    CHECK_THROWS_AS(score_disparity(inputs, {1}), io::InputError);
}

TEST_CASE("inputs that make no sense are refused before anything is read")
{
    DisparityInputs inputs;
    inputs.test = "missing.tif";
    CHECK_THROWS_AS(score_disparity(inputs, {1}), io::ConfigError);
    inputs.zbuffer = true;
    CHECK_THROWS_AS(score_seams(inputs, {64}), io::ConfigError);
    inputs.zbuffer = false;
    inputs.test_scale = 0;
    CHECK_THROWS_WITH(score_seams(inputs, {64}), Catch::Contains("--test-scale"));
    CHECK_THROWS_AS(score_seams(inputs, {1}), io::ConfigError);
}

TEST_CASE("a synthetic scene's truth scores perfectly against itself")
{
    const TemporaryFolder folder;
    const synth::DisparityBounds bounds = write_scene(little_city(), folder.path);
    CHECK(bounds.min_px <= 3);
    CHECK(bounds.max_px > 10);
    DisparityInputs inputs;
    inputs.test = inputs.truth = folder / "truth_left.tif";
    inputs.mask = folder / "visible_left.tif";
    const evaluate::DisparityScore by_mask = score_disparity(inputs, {0});
    CHECK(by_mask.density_percent == 100);
    CHECK(by_mask.bad[0].bad_percent == 0);
    // Both ways to find occlusions from truth agree with the exact mask, up to roofs' edges;
    // whole columns decide, so the z-buffer misses what shows for less than one.
    const double exact = static_cast<double>(by_mask.evaluated);
    inputs.mask.clear();
    inputs.truth_right = folder / "truth_right.tif";
    const auto by_cross_check = static_cast<double>(score_disparity(inputs, {0}).evaluated);
    CHECK(by_cross_check == Approx(exact).epsilon(0.01));
    inputs.truth_right.clear();
    inputs.zbuffer = true;
    const auto by_zbuffer = static_cast<double>(score_disparity(inputs, {0}).evaluated);
    CHECK(by_zbuffer == Approx(exact).epsilon(0.02));
}

TEST_CASE("a scene's files are the same bytes with any number of threads")
{
    const TemporaryFolder folder;
    write_scene(little_city(), folder / "many");
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    write_scene(little_city(), folder / "one");
    for (const char* name :
         {"left.tif", "right.tif", "truth_left.tif", "truth_right.tif", "visible_left.tif"}) {
        CAPTURE(name);
        CHECK(bytes_of_file(folder / "many" + "/" + name) ==
              bytes_of_file(folder / "one" + "/" + name));
    }
}
