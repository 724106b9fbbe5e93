#include "tests/end_to_end/pairs.h"
#include "tests/end_to_end/rasters.h"

#include <algorithm>
#include <cmath>

using namespace hsgm::tests;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

// Hides the CUDA devices that this machine may have.
class NoDevices {
public:
    NoDevices() { setenv("CUDA_VISIBLE_DEVICES", "-1", 1); }
    ~NoDevices() { unsetenv("CUDA_VISIBLE_DEVICES"); }
};

// NaN, which differs from itself, as the number that stands for it in the file.
std::vector<double> all_pixels_of(const std::string& path)
{
    const auto image = pixels_of(path);
    std::vector<double> pixels(image.data(), image.data() + image.size().area());
    std::replace_if(
        pixels.begin(), pixels.end(), [](double v) { return std::isnan(v); }, -32768.0);
    return pixels;
}

} // namespace

TEST_CASE("every command has help with an example")
{
    const std::vector<std::vector<std::string>> commands{{},
                                                         {"match"},
                                                         {"run"},
                                                         {"plan"},
                                                         {"bench"},
                                                         {"evaluate", "disparity"},
                                                         {"evaluate", "seams"},
                                                         {"synth"}};
    for (std::vector<std::string> command : commands) {
        command.emplace_back("--help");
        const Outcome outcome = hsgm_does(command);
        CHECK_THAT(outcome.out, Contains("\n  hsgm " + (command.size() > 1 ? command[0] : "")));
        CHECK(outcome.err.empty());
    }
    CHECK_THAT(hsgm_does({"evaluate", "--help"}).out, Contains("seams"));
    CHECK_THAT(hsgm_does({"info", "--help"}).out, Contains("hsgm info"));
    CHECK_THAT(hsgm_does({"info"}).out, Contains("GDAL"));
    CHECK_THAT(hsgm_does({"--version"}).out, Contains("hsgm 0."));
}

TEST_CASE("where no CUDA device can be used, info says why and auto matches on the processor")
{
    const NoDevices none;
    CHECK_THAT(hsgm_does({"info"}).out, Contains("\ndevices   cpu (no CUDA device: "));
    const TemporaryFolder folder;
    make_pair(folder);
    for (const std::string device : {"auto", "cpu"}) {
        hsgm_does({"match", folder / "left.tif", folder / "right.tif", "-o",
                   folder / (device + ".tif"), "--disparity", "0,10", "--device", device});
    }
    CHECK(all_pixels_of(folder / "auto.tif") == all_pixels_of(folder / "cpu.tif"));
    put_bytes(folder / "run.yaml", pair_config());
    const json plan = json::parse(hsgm_does({"plan", folder / "run.yaml", "--json"}).out);
    CHECK(plan["devices"] == json::parse(R"([{"device": "cpu"}])"));
}

TEST_CASE("plan tells as JSON what a run would do, and writes nothing")
{
    const TemporaryFolder folder;
    make_pair(folder, {200, 300});
    put_bytes(folder / "run.yaml", pair_config(", levels: 3"));
    const Snapshot before = snapshot(folder.path().string());
    const json plan = json::parse(
        hsgm_does({"plan", folder / "run.yaml", "--json", "--tile-size", "64"}).out);
    REQUIRE(plan["levels"].size() == 3);
    CHECK(plan["levels"][0]["rows"] == 200);
    CHECK(plan["levels"][0]["cols"] == 300);
    CHECK(plan["levels"][0]["disparity_min"] <= 0);
    CHECK(plan["levels"][0]["disparity_max"] >= 10);
    CHECK(plan["levels"][2]["rows"] == 50);
    CHECK(plan["levels"][2]["cols"] == 75);
    CHECK(plan["levels"][2]["disparity_max"] >= 2);
    CHECK(plan["tile_size_px"] == 64);
    CHECK(plan["tiles"] == 4 * 5);
    CHECK(plan["memory_bytes"]["estimate"] <= plan["memory_bytes"]["allowed"]);
    const Outcome dry = hsgm_does({"run", folder / "run.yaml", "--dry-run"});
    CHECK_THAT(dry.out, Contains("level 2") && Contains("75 x 50 px"));
    CHECK((snapshot(folder.path().string()) == before));
}

TEST_CASE("every configuration that is shipped works")
{
    const TemporaryFolder folder;
    make_pair(folder, {64, 400});
    hsgm_does({"synth", std::string(HSGM_CONFIGS_DIR) + "/scene-orbit.yaml", "-o",
               folder / "raw", "--set", "size=[300,300]"});
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(HSGM_CONFIGS_DIR)) {
        const std::string path = entry.path().string();
        INFO(path);
        if (entry.path().extension() != ".yaml") {
            continue;
        }
        if (entry.path().filename().string().starts_with("scene-")) {
            ++scenes;
            hsgm_does({"synth", path, "-o", folder / "scene", "--set", "size=[24,40]"});
        } else {
            const bool raw = entry.path().filename() == "demo.yaml"; // wants images with RPCs
            const std::string pair = raw ? "raw/" : "";
            hsgm_does({"plan", path, "--set", "pair.left=" + (folder / (pair + "left.tif")),
                       "--set", "pair.right=" + (folder / (pair + "right.tif"))});
        }
    }
    CHECK(scenes >= 4);
}
