#include "tests/end_to_end/pairs.h"
#include "tests/end_to_end/program.h"

#include "tests/catch.h"

#include <filesystem>

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

/// Two raw images of a small town, and a configuration for raw pairs.
class RawArchive {
public:
    RawArchive()
    {
        const Outcome made =
            run_hsgm({"--log-level", "warn", "synth", HSGM_CONFIGS_DIR "/scene-orbit.yaml",
                      "-o", at("scene"), "--set", "size=[260, 260]"});
        INFO(made.err);
        REQUIRE(made.code == 0);
        put_bytes(at("all.yaml"), "pair: {left: none.tif, right: none.tif}\n"
                                  "geometry: {kind: rpc}\n"
                                  "output: {folder: none}\n"
                                  "run: {threads: 1, memory: 600MiB}\n");
    }
    std::string at(const std::string& name) const { return folder_ / name; }
    void put_pair(const std::string& folder, const std::string& left, const std::string& right)
    {
        fs::create_directories(at(folder));
        fs::copy_file(at("scene/" + left), at(folder + "/left.tif"));
        fs::copy_file(at("scene/" + right), at(folder + "/right.tif"));
    }
    Outcome run_to(int code, const std::string& archive, const std::string& results,
                   const std::vector<std::string>& more = {}) const
    {
        std::vector<std::string> words{"batch", at(archive), "-c",     at("all.yaml"),
                                       "-o",    at(results), "--jobs", "2"};
        words.insert(words.end(), more.begin(), more.end());
        Outcome outcome = run_hsgm(words);
        INFO(outcome.err);
        CHECK(outcome.code == code);
        return outcome;
    }
    std::string text(const std::string& name) const
    {
        return io::samples::bytes_of_file(at(name));
    }

private:
    TemporaryFolder folder_;
};

} // namespace

TEST_CASE("an archive of raw pairs is worked through, and one that is no pair does not matter")
{
    RawArchive archive;
    archive.put_pair("pairs/good", "left.tif", "right.tif");
    archive.put_pair("pairs/swapped", "right.tif", "left.tif");
    archive.put_pair("pairs/twice", "left.tif", "left.tif");
    archive.put_pair("pairs/bare", "left.tif", "truth_dsm.tif");
    const Outcome outcome = archive.run_to(5, "pairs", "results");
    CHECK_THAT(outcome.err, Contains("2 of 4 pairs failed"));
    CHECK_THAT(archive.text("results/summary.csv"),
               Contains("good,done,0,") && Contains("swapped,done,0,") &&
                   Contains("twice,input,3,") && Contains("nearly the same place") &&
                   Contains("bare,input,3,") && Contains("has no RPC"));
    for (const char* name : {"good", "swapped"}) {
        CHECK(rasters_in(archive.at(std::string("results/") + name)).size() >= 9);
    }
    CHECK_FALSE(fs::exists(archive.at("results/twice/disparity.tif")));
    // The same by a manifest, one pair with a cell size of its own, then resumed.
    put_bytes(archive.at("pairs.csv"), "name,left,right,dsm.gsd_m\n"
                                       "plain,pairs/good/left.tif,pairs/good/right.tif,\n"
                                       "coarse,pairs/good/left.tif,pairs/good/right.tif,0.8\n"
                                       "missing,pairs/good/left.tif,pairs/none.tif,\n");
    archive.run_to(5, "pairs.csv", "more");
    CHECK((rasters_in(archive.at("more/plain")) == rasters_in(archive.at("results/good"))));
    CHECK(archive.text("more/coarse/dsm.tif") != archive.text("more/plain/dsm.tif"));
    CHECK(archive.text("more/coarse/disparity.tif") ==
          archive.text("more/plain/disparity.tif"));
    const auto untouched = fs::last_write_time(archive.at("more/plain/dsm.tif"));
    fs::copy_file(archive.at("scene/right.tif"), archive.at("pairs/none.tif"));
    archive.run_to(0, "pairs.csv", "more", {"--resume"});
    CHECK((rasters_in(archive.at("more/missing")) == rasters_in(archive.at("more/plain"))));
    CHECK(fs::last_write_time(archive.at("more/plain/dsm.tif")) == untouched);
}
