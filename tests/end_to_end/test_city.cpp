#include "tests/end_to_end/pairs.h"
#include "tests/end_to_end/rasters.h"

using namespace hsgm::tests;
using nlohmann::json;

namespace {

const std::string kCity = R"(size: [320, 448]
seed: 4
city: {cell_px: 80, height_min_px: 3, height_max_px: 20}
left: {noise_gray: 1}
right: {noise_gray: 1, gain: 0.9, offset: 0.02}
)";

const std::string kRun = R"(pair: {left: scene/left.tif, right: scene/right.tif}
geometry: {kind: rectified, height_per_px_m: 0.5, reference_height_m: 40}
output: {folder: result}
matcher: {disparity: [0, 31]}
)";

// The scene rendered, matched and waiting in result/.
void make_city(const TemporaryFolder& folder)
{
    put_bytes(folder / "city.yaml", kCity);
    put_bytes(folder / "run.yaml", kRun);
    hsgm_does({"synth", folder / "city.yaml", "-o", folder / "scene"});
    hsgm_does({"run", folder / "run.yaml"});
}

} // namespace

TEST_CASE("a city goes from its scene file to heights with a small error")
{
    const TemporaryFolder folder;
    make_city(folder);
    const json score = json::parse(
        hsgm_does({"evaluate", "disparity", folder / "result/disparity.tif",
                   folder / "scene/truth_left.tif", "--mask", folder / "scene/visible_left.tif",
                   "--thresholds", "1,2", "--json"})
            .out);
    CHECK(score["density_percent"] > 95);
    CHECK(score["bad"][0]["bad_answered_percent"] < 3);
    CHECK(std::abs(score["median_error_px"].get<double>()) < 0.05);
    CHECK(score["nmad_px"] < 0.2);
    const json seams =
        json::parse(hsgm_does({"evaluate", "seams", folder / "result/disparity.tif", "--truth",
                               folder / "scene/truth_left.tif", "--mask",
                               folder / "scene/visible_left.tif", "--window", "64", "--json"})
                        .out);
    CHECK(seams["window_64"]["border_pairs"] > 1000);
    CHECK(seams["window_64"]["ratio_low"] <= 1.05); // so few borders: a wide interval
}

TEST_CASE("a city's confidence tells where its errors are")
{
    const TemporaryFolder folder;
    make_city(folder);
    const auto evaluate = [&](std::vector<std::string> more) {
        std::vector<std::string> command{"evaluate",
                                         "disparity",
                                         folder / "result/disparity.tif",
                                         folder / "scene/truth_left.tif",
                                         "--confidence",
                                         folder / "result/confidence.tif"};
        command.insert(command.end(), more.begin(), more.end());
        return hsgm_does(command).out;
    };
    const json score = json::parse(evaluate({"--json"}))["confidence"];
    CHECK(score["threshold_px"] == 1);
    REQUIRE(score["curve"].size() == 5);
    CHECK(score["curve"][1]["dropped_percent"] == 10);
    CHECK(score["curve"][1]["bad_percent"] < score["curve"][0]["bad_percent"]);
    CHECK(score["area_percent"] > score["optimal_area_percent"]);
    CHECK(score["calibration_error"] < 0.1);
    CHECK(score["classes"][0]["confidence"] >= 128);
    CHECK_THAT(evaluate({"--confidence-px", "2"}),
               Catch::Matchers::Contains("error above 2 px among the rest"));
}

TEST_CASE("holes are made up only where that is asked for, and say so")
{
    const TemporaryFolder folder;
    make_city(folder);
    const auto answered = [&] {
        return json::parse(hsgm_does({"evaluate", "disparity", folder / "result/disparity.tif",
                                      folder / "scene/truth_left.tif", "--json"})
                               .out)["density_percent"]
            .get<double>();
    };
    const double measured = answered();
    const std::string said =
        hsgm_does({"run", folder / "run.yaml", "--set", "matcher.fill=all"}).err;
    CHECK(answered() > measured + 3);
    CHECK_THAT(said, Catch::Matchers::Contains("interpolated"));
}

TEST_CASE("a run writes its rasters and its configuration, and from that the same again")
{
    const TemporaryFolder folder;
    make_city(folder);
    Snapshot first = rasters_in(folder / "result");
    CHECK(names_in(first) == std::vector<std::string>{"confidence.tif", "disparity.tif",
                                                      "height.tif", "hillshade.tif",
                                                      "reasons.tif"});
    CHECK(std::filesystem::exists(folder / "result/config.used.yaml"));
    CHECK_FALSE(std::filesystem::exists(folder / "result/work"));
    hsgm_does({"run", folder / "result/config.used.yaml", "-o", folder / "again", "--tile-size",
               "100", "--threads", "1"});
    CHECK((first == rasters_in(folder / "again")));
}

TEST_CASE("a run replaces the results of an earlier one")
{
    const TemporaryFolder folder;
    make_city(folder);
    const Snapshot first = snapshot(folder / "result");
    hsgm_does({"run", folder / "run.yaml", "--set", "matcher.disparity=[0,9]"});
    Snapshot second = snapshot(folder / "result");
    CHECK(names_in(second) == names_in(first));
    CHECK(second["disparity.tif"] != first.at("disparity.tif"));
    CHECK_THAT(second["config.used.yaml"], Catch::Matchers::Contains("disparity: [0, 9]"));
}
