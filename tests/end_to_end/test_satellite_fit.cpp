// What raw pairs are matched with and what is kept of their cells: penalties that fit how alike
// the images are, and cells that are sure enough.

#include "tests/end_to_end/raw_place.h"

using namespace hsgm::tests;
using hsgm::io::samples::bytes_of_file;

namespace {

std::string penalties_of(const std::string& raster)
{
    return gdalinfo(raster)["metadata"][""]["HSGM_PENALTIES"];
}

json likeness_of(const std::string& result)
{
    return json::parse(bytes_of_file(result + "/run.json"))["geometry"]["likeness"];
}

} // namespace

TEST_CASE("penalties fit how alike the images of a raw pair are, unless they are given")
{
    const RawPlace place;
    const Outcome first = place.run("fitted");
    INFO(first.err);
    REQUIRE(first.code == 0);
    CHECK(first.err.find(" % of windows unlike") != std::string::npos);
    CHECK(penalties_of(place / "fitted/dsm.tif") == "p1 12, p2 48, half at tone step 5");
    const json likeness = likeness_of(place / "fitted");
    CHECK(likeness["windows"] > 5000);
    CHECK(likeness["unlike_share"] < 0.05);

    // The configuration that the run keeps says the same as the one it was given.
    REQUIRE(run_hsgm({"run", place / "fitted/config.used.yaml", "-o", place / "again"}).code ==
            0);
    CHECK(bytes_of_file(place / "again/dsm.tif") == bytes_of_file(place / "fitted/dsm.tif"));

    for (const char* given : {"matcher.penalties=fixed", "matcher.p2=192"}) {
        CAPTURE(given);
        REQUIRE(place.run("fixed", {"--set", given}).code == 0);
        CHECK(penalties_of(place / "fixed/dsm.tif") == "p1 24, p2 192, half at tone step 5");
        CHECK(likeness_of(place / "fixed").is_null());
        CHECK(bytes_of_file(place / "fixed/dsm.tif") !=
              bytes_of_file(place / "fitted/dsm.tif"));
        std::filesystem::remove_all(place / "fixed");
    }
    // Fitted all the same where that is asked for.
    REQUIRE(place
                .run("scaled", {"--set", "matcher.p1=32", "--set", "matcher.p2=200", "--set",
                                "matcher.penalties=auto"})
                .code == 0);
    CHECK(penalties_of(place / "scaled/dsm.tif") == "p1 16, p2 50, half at tone step 5");
}

TEST_CASE("images in which noise has drowned the texture keep their penalties")
{
    const RawPlace place;
    std::string scene = bytes_of_file(place / "scene.yaml");
    for (std::size_t at = 0; (at = scene.find("noise_gray: 5", at)) != std::string::npos;) {
        scene.replace(at, 13, "noise_gray: 60");
    }
    put_bytes(place / "noisy.yaml", scene);
    hsgm_does({"synth", place / "noisy.yaml", "-o", place / "noisy"});
    const Outcome outcome =
        place.run("result", {"--set", "pair.left=" + place / "noisy/left.tif", "--set",
                             "pair.right=" + place / "noisy/right.tif"});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    CHECK(likeness_of(place / "result")["unlike_share"] > 0.2);
    CHECK(penalties_of(place / "result/dsm.tif") == "p1 24, p2 192, half at tone step 5");
}

TEST_CASE("cells less confident than asked for have no height, and the others are the same")
{
    const RawPlace place;
    REQUIRE(place.run("all", {"--set", "dsm.min_confidence=0"}).code == 0);
    REQUIRE(place.run("sure").code == 0);
    constexpr double kUncertain = 8;
    const auto all = pixels_of(place / "all/dsm.tif");
    const auto confidence = pixels_of(place / "all/dsm.confidence.tif");
    const auto sure = pixels_of(place / "sure/dsm.tif");
    const auto reasons = pixels_of(place / "sure/dsm.reasons.tif");
    REQUIRE(all.size() == sure.size());
    int taken = 0;
    int wrong = 0;
    for (std::int64_t i = 0; i < all.size().area(); ++i) {
        if (std::isnan(all.data()[i])) {
            wrong += !std::isnan(sure.data()[i]);
        } else if (confidence.data()[i] < 180) {
            ++taken;
            wrong += !std::isnan(sure.data()[i]) || reasons.data()[i] != kUncertain;
        } else {
            wrong += sure.data()[i] != all.data()[i] || reasons.data()[i] != 0;
        }
    }
    CHECK(wrong == 0);
    CHECK(taken > 1000);
    const auto heights = pixels_of(place / "all/height.tif"); // of the frame's pixels: all kept
    const auto kept = pixels_of(place / "sure/height.tif");
    wrong = 0;
    for (std::int64_t i = 0; i < heights.size().area(); ++i) {
        wrong += std::isnan(heights.data()[i]) != std::isnan(kept.data()[i]);
    }
    CHECK(wrong == 0);
    const json before = place.score("all");
    const json after = place.score("sure");
    CHECK(after["rmse_m"].get<double>() < 0.9 * before["rmse_m"].get<double>());
    CHECK(after["completeness_percent"].get<double>() >
          before["completeness_percent"].get<double>() - 4);
}

TEST_CASE("keys of raw pairs say so where they stand elsewhere or are out of range")
{
    const RawPlace place;
    const std::vector<std::string> rectified{"--set", "geometry.kind=rectified", "--set",
                                             "matcher.disparity=[0, 9]", "--set"};
    const auto with = [&](const std::string& key) {
        auto arguments = rectified;
        arguments.push_back(key);
        return arguments;
    };
    says(place.run("r", with("matcher.penalties=auto")), 2,
         "'matcher.penalties' is 'auto', which is for geometry kind rpc or ortho only");
    says(place.run("r", with("dsm.min_confidence=100")), 2,
         "'dsm.min_confidence' is for geometry kind rpc or ortho only");
    says(place.run("r", {"--set", "dsm.min_confidence=256"}), 2, "from 0 to 255");
    says(place.run("r", {"--set", "matcher.penalties=small"}), 2, "auto");
    says(run_hsgm({"match", place / "scene/left.tif", place / "scene/right.tif", "-o",
                   place / "d.tif", "--disparity=0,9", "--set", "matcher.penalties=auto"}),
         2, "unknown key 'matcher.penalties'");
}
