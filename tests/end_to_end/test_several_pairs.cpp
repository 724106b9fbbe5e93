// Several raw images of one area become one DSM.

#include "tests/end_to_end/raw_place.h"

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

using namespace hsgm::tests;

namespace {

/// The scene seen a third time, from the south and with a pointing error of its own.
class ThreeViews {
public:
    ThreeViews()
    {
        std::string scene = kRawScene;
        const std::string right =
            "right: {toward_east: -0.17, toward_north: -0.03, turn_deg: TURN, "
            "written_col_px: 1.1, written_row_px: -1.7}";
        scene.replace(scene.find(right), right.size(),
                      "right: {toward_east: 0.02, toward_north: -0.16, turn_deg: 5, "
                      "written_col_px: -0.6, written_row_px: 0.9}");
        put_bytes(place_ / "third.yaml", scene);
        hsgm_does({"synth", place_ / "third.yaml", "-o", place_ / "third"});
        put_bytes(place_ / "all.yaml",
                  "images: {left: scene/left.tif, right: {path: scene/right.tif}, third: "
                  "third/right.tif}\n"
                  "geometry: {kind: rpc}\n"
                  "output: {folder: fused}\n");
    }
    const RawPlace& place() const { return place_; }
    std::string operator/(const std::string& name) const { return place_ / name; }

    Outcome run(const std::string& result, std::vector<std::string> more = {}) const
    {
        more.insert(more.begin(),
                    {"run", place_ / "all.yaml", "-o", place_ / result, "--threads", "2"});
        return run_hsgm(more);
    }
    /// Over all the land, whoever sees it.
    json score(const std::string& folder) const
    {
        return json::parse(
            hsgm_does({"evaluate", "dsm", place_ / (folder + "/dsm.tif"),
                       place_ / "scene/truth_dsm.tif", "--classes",
                       place_ / "scene/truth_classes.tif", "--align-classes", "0", "--json"})
                .out);
    }
    json record(const std::string& folder) const
    {
        std::ifstream file(place_ / (folder + "/run.json"));
        return json::parse(file);
    }

private:
    RawPlace place_;
};

constexpr std::initializer_list<const char*> kFused{
    "dsm.tif",         "dsm.confidence.tif", "dsm.points.tif", "dsm.spread.tif",
    "dsm.reasons.tif", "dsm.pairs.tif",      "hillshade.tif"};

void same_rasters(const Snapshot& a, const Snapshot& b)
{
    for (const char* file : kFused) {
        CAPTURE(file);
        REQUIRE(a.contains(file));
        CHECK(a.at(file) == b.at(file));
    }
}

} // namespace

TEST_CASE("three views become one DSM, more complete than any pair's and no noisier")
{
    const ThreeViews views;
    const Outcome first = views.run("fused");
    INFO(first.err);
    REQUIRE(first.code == 0);
    const json all = views.score("fused");
    CAPTURE(all.dump(1));
    double best_nmad = 1e9;
    const json record = views.record("fused");
    CHECK(record["pairs"].size() == 3);
    for (const auto& pair : record["pairs"]) {
        const std::string name = pair["name"];
        CAPTURE(name);
        const json one = views.score("fused/pairs/" + name);
        CHECK(all["completeness_percent"].get<double>() >
              one["completeness_percent"].get<double>() + 1.0);
        best_nmad = std::min(best_nmad, one["nmad_m"].get<double>());
    }
    CHECK(all["nmad_m"].get<double>() <= best_nmad + 0.002);

    // Every cell has a height or a reason, and as many pairs as it has heights.
    const auto heights = pixels_of(views / "fused/dsm.tif");
    const auto reasons = pixels_of(views / "fused/dsm.reasons.tif");
    const auto pairs = pixels_of(views / "fused/dsm.pairs.tif");
    int wrong = 0;
    int agreed = 0;
    for (std::size_t i = 0; i < heights.pixels().size(); ++i) {
        const bool none = std::isnan(heights.data()[i]);
        wrong += none != (reasons.data()[i] != 0) || none != (pairs.data()[i] == 0);
        agreed += pairs.data()[i] == 3;
    }
    CHECK(wrong == 0);
    CHECK(agreed > 100000);

    // Listed the other way round, other threads and tiles, and one image twice as a map.
    const std::string listed =
        "pairs=[{left: third, right: right}, {left: third, right: left}, "
        "{left: left, right: right}]";
    const Outcome again =
        views.run("again", {"--set", listed, "--tile-size", "100", "--set", "run.threads=1"});
    INFO(again.err);
    const auto chosen = views.record("fused")["pairs"];
    std::vector<std::string> names;
    for (const auto& pair : chosen) {
        names.push_back(pair["name"]);
    }
    CHECK(again.code == 0);
    // The same from the finished runs, in another order.
    std::vector<std::string> fuse{"fuse", "-o", views / "by_hand"};
    for (auto name = names.rbegin(); name != names.rend(); ++name) {
        fuse.push_back(views / ("fused/pairs/" + *name));
    }
    hsgm_does(fuse);
    same_rasters(snapshot(views / "fused"), snapshot(views / "by_hand"));

    // Nothing is left to do; and what is lost is made again, to the same bytes.
    const Snapshot before = snapshot(views / "fused");
    const Outcome resumed = views.run("fused", {"--resume"});
    CHECK(resumed.code == 0);
    CHECK(resumed.err.find("everything is done already") != std::string::npos);
    std::filesystem::remove(views / "fused/dsm.tif");
    std::filesystem::remove_all(views / ("fused/pairs/" + names[1]));
    REQUIRE(views.run("fused", {"--resume"}).code == 0);
    same_rasters(before, snapshot(views / "fused"));
}

TEST_CASE("a run of several pairs that is killed goes on, to the same bytes")
{
    const ThreeViews views;
    REQUIRE(views.run("whole").code == 0);
    const Snapshot whole = snapshot(views / "whole");
    for (const int at_pair : {1, 2}) {
        CAPTURE(at_pair);
        const std::string result = "killed" + std::to_string(at_pair);
        {
            RunningProgram run({hsgm_program(), "run", views / "all.yaml", "-o", views / result,
                                "--threads", "2"});
            // Killed when its pair of that number has begun.
            const auto begun = [&] {
                int count = 0;
                const std::filesystem::path pairs = views / (result + "/pairs");
                std::error_code none;
                for (const auto& entry : std::filesystem::directory_iterator(pairs, none)) {
                    count += entry.path().extension() == ".yaml";
                }
                return count;
            };
            while (begun() < at_pair && !run.has_ended()) {
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(500));
            run.signal(SIGKILL);
            CHECK(run.wait().code == -SIGKILL);
        }
        CHECK_FALSE(std::filesystem::exists(views / (result + "/dsm.tif")));
        const Outcome resumed = views.run(result, {"--resume"});
        INFO(resumed.err);
        REQUIRE(resumed.code == 0);
        same_rasters(whole, snapshot(views / result));
    }
}

TEST_CASE("the order of a list of pairs changes nothing, and one that fails is told")
{
    const ThreeViews views;
    const std::string first = "{left: left, right: right}";
    const std::string second = "{left: left, right: third}";
    REQUIRE(views.run("a", {"--set", "pairs=[" + first + ", " + second + "]"}).code == 0);
    REQUIRE(
        views.run("b", {"--set", "pairs=[" + second + ", " + first + "]", "--tile-size", "100"})
            .code == 0);
    same_rasters(snapshot(views / "a"), snapshot(views / "b"));
    // An image without a partner: two pairs go on without it.
    put_bytes(views / "all.yaml",
              "images: {left: scene/left.tif, right: scene/right.tif, third: third/right.tif,\n"
              "         again: scene/left.tif}\n"
              "geometry: {kind: rpc}\n"
              "output: {folder: fused}\n");
    const Outcome failing = views.run(
        "c", {"--set", "pairs=[" + first + ", " + second + ", {left: left, right: again}]"});
    says(failing, 5, "1 of 3 pairs failed: left-again: ");
    says(failing, 5, "nearly the same place");
    same_rasters(snapshot(views / "a"), snapshot(views / "c"));
    // Chosen by geometry, that pair is left out from the start.
    const Outcome planned = views.run("d", {"--dry-run"});
    CHECK(planned.code == 0);
    CHECK(planned.out.find("left out: again-left: ") != std::string::npos);
}

TEST_CASE("several pairs that cannot be are refused in one sentence")
{
    const ThreeViews views;
    const auto refused = [&](const std::vector<std::string>& settings, int code,
                             const std::string& part) {
        std::vector<std::string> more;
        for (const std::string& setting : settings) {
            more.insert(more.end(), {"--set", setting});
        }
        says(views.run("r", more), code, part);
    };
    refused({"images={left: scene/left.tif}"}, 2, "must name two images or more");
    refused({"pairs=[{left: left, right: fourth}]"}, 2,
            "is 'fourth', which `images` does not name; there are left, right, third");
    refused({"pairs=[{left: left, right: left}]"}, 2, "is the same image as left");
    refused({"pairs=[{left: left, right: right}, {left: left, right: right}]"}, 2,
            "are a pair that comes twice");
    refused({"pair={left: a.tif, right: b.tif}"}, 2, "'pair' and images both name images");
    refused({"geometry.kind=rectified"}, 2, "must be rpc where there are several pairs");
    refused({"geometry.stored=x.json"}, 2, "is of one pair, but there are several");
    refused(
        {"images={a: scene/left.tif, b: scene/left.tif}"}, 3,
        "no two of the images make a pair; a-b: the images were taken from nearly the same");
    refused({"matcher.p3=1"}, 2, "'matcher.p3'");
    refused({"dsm.crs=EPSG:4326"}, 2,
            "'dsm.crs' is in degrees, but several pairs are fused on a map in metres");
    says(views.run("r", {"--shard", "0/2"}), 2, "--shard, --stage and --take-over are for one");
    says(run_hsgm({"plan", views / "all.yaml"}), 2, "is for several pairs of one area");
    says(run_hsgm({"fuse", views / "scene", views / "third", "-o", views / "r"}), 2,
         "holds no finished run of a raw pair");
}
