#include "tests/catch.h"

#include "tests/seam/run_files.h"

#include "pipeline/stages/scene_config.h"
#include "pipeline/stages/synth_stage.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

using namespace hsgm;
using namespace hsgm::seam;
using tiling::TileOrder;

// Tile invariance on real pairs and on one of 24 megapixels: issue 2's matrix. Real pairs
// come from the data folder: environment variable HSGM_DATA_DIR, or beside the sources.
namespace {

std::filesystem::path data_folder()
{
    const char* named = std::getenv("HSGM_DATA_DIR");
    return named != nullptr ? named : HSGM_DEFAULT_DATA_DIR;
}

std::vector<Manner> matrix()
{
    std::vector<Manner> manners{{0, 2}};
    for (const int threads : {1, 2}) {
        for (const int tile : {1000, 256, 100, 64}) {
            manners.push_back({tile, threads, TileOrder::shuffled});
        }
    }
    manners.push_back({0, 1});
    manners.push_back({256, 2, TileOrder::columns});
    manners.push_back({std::nullopt, 2, TileOrder::rows, 512 << 20});
    return manners;
}

void check_real_pair(const std::string& pair, tiling::DisparityRange asked)
{
    const auto inputs = data_folder() / pair;
    if (!std::filesystem::exists(inputs)) {
        WARN("SKIPPED: no " + inputs.string() + "; see HSGM_DATA_DIR");
        return;
    }
    const TemporaryFolder folder;
    pipeline::Job job;
    job.left.path = (inputs / "left.png").string();
    job.right.path = (inputs / "right.png").string();
    job.disparity = asked;
    set_outputs(job, folder.path());
    CHECK(differences_between(job, matrix()) == "");
}

} // namespace

TEST_CASE("Dolls at full size is the same for every tiling")
{
    check_real_pair("middlebury_2005_2006_full/Dolls", {0, 255});
}

TEST_CASE("a satellite pair is the same for every tiling")
{
    check_real_pair("sat_us3d_JAX_079_006_007", {-64, 63});
}

TEST_CASE("a scene of 6000 x 4000 px is the same for every tiling")
{
    const TemporaryFolder folder;
    const auto scene = pipeline::read_scene(HSGM_CONFIGS_DIR "/scene-large.yaml").scene;
    const auto bounds = pipeline::write_scene(scene, folder.path().string());
    pipeline::Job job;
    job.left.path = (folder.path() / "left.tif").string();
    job.right.path = (folder.path() / "right.tif").string();
    job.disparity = {static_cast<int>(std::floor(bounds.min_px)),
                     static_cast<int>(std::ceil(bounds.max_px))};
    set_outputs(job, folder.path());
    CHECK(differences_between(job, matrix()) == "");
}
