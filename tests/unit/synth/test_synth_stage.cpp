#include "tests/catch.h"

#include "io/error.h"
#include "pipeline/stages/scene_config.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

using namespace hsgm;
using namespace hsgm::pipeline;

namespace {

// A scene file for one test.
class SceneFile {
public:
    explicit SceneFile(const std::string& yaml)
        : path_(std::filesystem::temp_directory_path() /
                ("hsgm_scene_" + std::to_string(::getpid()) + ".yaml"))
    {
        std::ofstream(path_) << yaml;
    }
    ~SceneFile() { std::filesystem::remove(path_); }
    std::string path() const { return path_.string(); }

private:
    std::filesystem::path path_;
};

} // namespace

TEST_CASE("every scene that is shipped can be read")
{
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(HSGM_CONFIGS_DIR)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("scene-")) {
            CAPTURE(name);
            CHECK_NOTHROW(read_scene(entry.path().string()));
            ++scenes;
        }
    }
    CHECK(scenes >= 4);
}

TEST_CASE("a scene file sets what it names and leaves the rest")
{
    const SceneFile file(
        "size: [30, 40]\n"
        "terrain: {offset_px: 3, waves: [{amplitude_px: 2}]}\n"
        "objects:\n"
        "  - {shape: ellipse, center_x: 1, center_y: 2, length_px: 3,\n"
        "     width_px: 4, height_px: 5, roof: gable, rise_px: 0.5}\n"
        "right: {gain: 0.5, holes: [{center_x: 1, center_y: 2, radius_px: 3}]}\n");
    const synth::Scene scene = read_scene(file.path()).scene;
    CHECK(scene.size == tiling::Size{30, 40});
    CHECK(scene.bits == 8);
    CHECK(scene.terrain.offset_px == 3);
    REQUIRE(scene.terrain.waves.size() == 1);
    CHECK(scene.terrain.waves[0].wavelength_px == 512);
    REQUIRE(scene.objects.size() == 1);
    CHECK(scene.objects[0].shape == synth::Shape::ellipse);
    CHECK(scene.objects[0].roof == synth::Roof::gable);
    CHECK_FALSE(scene.city.has_value());
    CHECK(scene.left.gain == 1);
    CHECK(scene.right.gain == 0.5);
    CHECK(scene.right.holes.size() == 1);
}

TEST_CASE("overrides win over the file, and the used scene reads back as the same")
{
    const SceneFile file("size: [30, 40]\ncity: {fill: 0.5}\n");
    const SceneConfig config =
        read_scene(file.path(), {"size=[7, 9]", "city.cell_px=48", "left.noise_gray=2"});
    CHECK(config.scene.size == tiling::Size{7, 9});
    REQUIRE(config.scene.city.has_value());
    CHECK(config.scene.city->fill == 0.5);
    CHECK(config.scene.city->cell_px == 48);
    const SceneFile used(config.used_yaml);
    const SceneConfig again = read_scene(used.path());
    CHECK(again.scene.size == tiling::Size{7, 9});
    CHECK(again.scene.city->cell_px == 48);
    CHECK(again.scene.left.noise_gray == 2);
}

TEST_CASE("a scene file's mistakes are refused by key")
{
    const SceneFile file("size: [30, 40]\n");
    const auto refusal = [&](const std::string& assignment) {
        return [&file, assignment] { read_scene(file.path(), {assignment}); };
    };
    CHECK_THROWS_WITH(refusal("city.hight_max_px=3")(), Catch::Contains("city.hight_max_px"));
    CHECK_THROWS_WITH(refusal("size=[1.5, 3]")(), Catch::Contains("size"));
    CHECK_THROWS_WITH(refusal("terrain.slope_x=0.7")(), Catch::Contains("slope"));
    CHECK_THROWS_AS(refusal("bits=17")(), io::ConfigError);
}
