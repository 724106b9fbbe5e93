#include "tests/catch.h"

#include "pipeline/stages/evaluate_stage.h"

#include <cstdlib>
#include <filesystem>
#include <string>

using namespace hsgm;
using namespace hsgm::pipeline;

// The published PatchMatch Stereo maps (Middlebury v2, algorithm 117) and their published
// scores, from the data folder: environment variable HSGM_DATA_DIR, or beside the sources.
namespace {

std::string data_folder()
{
    const char* named = std::getenv("HSGM_DATA_DIR");
    return named != nullptr ? named : HSGM_DEFAULT_DATA_DIR;
}

double bad_percent(const std::string& scene, const std::string& scale, const std::string& mask)
{
    const std::string folder = data_folder() + "/middlebury_" + scene + "/";
    DisparityInputs inputs;
    inputs.test = folder + "reference_result_alg117_x" + scale + ".png";
    inputs.truth = folder + "disp_left_x" + scale + ".png";
    inputs.mask = folder + "mask_" + mask + ".png";
    inputs.mask_value = 255;
    inputs.test_scale = inputs.truth_scale = std::stod(scale);
    return score_disparity(inputs, {1}).bad[0].bad_percent;
}

} // namespace

TEST_CASE("published scores are reproduced")
{
    if (!std::filesystem::exists(data_folder() + "/middlebury_cones")) {
        WARN("SKIPPED: no test data in " + data_folder() + "; see HSGM_DATA_DIR");
        return;
    }
    // They are published with two decimals.
    CHECK(bad_percent("cones", "4", "nonocc") == Approx(2.47).margin(0.005));
    CHECK(bad_percent("cones", "4", "all") == Approx(7.80).margin(0.005));
    CHECK(bad_percent("cones", "4", "disc") == Approx(7.11).margin(0.005));
    CHECK(bad_percent("tsukuba", "16", "nonocc") == Approx(2.09).margin(0.005));
    CHECK(bad_percent("tsukuba", "16", "all") == Approx(2.33).margin(0.005));
    CHECK(bad_percent("tsukuba", "16", "disc") == Approx(9.31).margin(0.005));
}
