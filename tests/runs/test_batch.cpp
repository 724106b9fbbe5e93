#include "tests/runs/run_place.h"

#include "tests/catch.h"

#include <csignal>
#include <filesystem>

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

/// Three folders of pairs, and a configuration for all of them.
class Archive {
public:
    explicit Archive(tiling::Size size = {100, 120})
    {
        for (const char* name : {"east", "north", "west"}) {
            fs::create_directories(at(std::string("pairs/") + name));
            const Pixels left = noise(size, static_cast<std::uint32_t>(name[0]));
            make_raster(at(std::string("pairs/") + name + "/left.tif"), GDT_Byte, size, {left});
            make_raster(at(std::string("pairs/") + name + "/right.tif"), GDT_Byte, size,
                        {shifted(left, size, 5)});
        }
        put_bytes(at("all.yaml"), "pair: {left: none.tif, right: none.tif}\n"
                                  "geometry: {kind: rectified}\n"
                                  "output: {folder: none}\n"
                                  "run: {tile_size: 64}\n"
                                  "matcher: {disparity: [0, 15]}\n");
    }
    std::string at(const std::string& name) const { return folder_ / name; }
    std::vector<std::string> command(const std::string& manifest,
                                     const std::vector<std::string>& more = {}) const
    {
        std::vector<std::string> words{hsgm_program(), "batch", at(manifest), "-c",
                                       at("all.yaml"), "-o",    at("results")};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    Outcome run_to(int code, const std::string& manifest,
                   const std::vector<std::string>& more = {}) const
    {
        Outcome outcome = run_program(command(manifest, more));
        INFO(outcome.err);
        CHECK(outcome.code == code);
        return outcome;
    }
    std::string text(const std::string& name) const
    {
        return io::samples::bytes_of_file(at(name));
    }
    Snapshot rasters(const std::string& pair) const
    {
        return rasters_in(at("results/" + pair));
    }

private:
    TemporaryFolder folder_;
};

} // namespace

TEST_CASE("a folder of pairs is worked through, each pair as a run of its own")
{
    const Archive archive;
    const Outcome outcome = archive.run_to(0, "pairs", {"--jobs", "2"});
    const std::string summary = archive.text("results/summary.csv");
    for (const char* name : {"east", "north", "west"}) {
        CHECK_THAT(summary, Contains(std::string(name) + ",done,0,"));
        CHECK_THAT(outcome.out, Contains(name));
        CHECK(archive.rasters(name).size() == 3);
        CHECK(fs::exists(archive.at(std::string("results/") + name + "/logs/job.log")));
    }
    CHECK(archive.rasters("east") != archive.rasters("west"));
    const Outcome status = run_hsgm({"status", archive.at("results")});
    CHECK(status.code == 0);
    CHECK_THAT(status.out, Contains("east") && Contains("north") && Contains("west") &&
                               Contains("finished") && Contains("4 of 4 tiles, 0 failed"));
}

TEST_CASE("a pair that fails does not disturb the others, and is made up for later")
{
    const Archive archive;
    const std::string right = archive.text("pairs/north/right.tif");
    put_bytes(archive.at("pairs/north/right.tif"), "no image");
    const Outcome failed = archive.run_to(5, "pairs");
    CHECK_THAT(failed.err, Contains("1 of 3 pairs failed"));
    CHECK_THAT(archive.text("results/summary.csv"), Contains("east,done,0,") &&
                                                        Contains("north,input,3,") &&
                                                        Contains("west,done,0,"));
    CHECK(archive.rasters("north").empty());
    const auto untouched = fs::last_write_time(archive.at("results/east/disparity.tif"));
    put_bytes(archive.at("pairs/north/right.tif"), right);
    archive.run_to(0, "pairs", {"--resume"});
    CHECK_THAT(archive.text("results/summary.csv"), Contains("north,done,0,"));
    CHECK(archive.rasters("north").size() == 3);
    CHECK(fs::last_write_time(archive.at("results/east/disparity.tif")) == untouched);
}

TEST_CASE("manifests name pairs and what each has of its own")
{
    const Archive archive;
    put_bytes(
        archive.at("pairs.csv"),
        "name,left,right,matcher.disparity,matcher.cost\n"
        "plain,pairs/east/left.tif,pairs/east/right.tif,,\n"
        "\"other, wide\",pairs/east/left.tif,pairs/east/right.tif,\"[0, 20]\",census5x5\n");
    archive.run_to(0, "pairs.csv");
    CHECK_THAT(archive.text("results/other, wide/config.used.yaml"),
               Contains("census5x5") && Contains("20"));
    CHECK_THAT(archive.text("results/plain/config.used.yaml"), Contains("ternary5x5"));
    CHECK_THAT(archive.text("results/summary.csv"), Contains("\"other, wide\",done,0,"));
    put_bytes(archive.at("pairs.yaml"),
              "pairs:\n"
              "  - {name: third, left: pairs/east/left.tif, right: pairs/east/right.tif,\n"
              "     set: {matcher.disparity: [0, 20], matcher.cost: census5x5}}\n");
    archive.run_to(0, "pairs.yaml");
    CHECK((archive.rasters("third") == archive.rasters("other, wide")));
}

TEST_CASE("bad manifests are refused before any pair begins")
{
    const Archive archive;
    const auto refused = [&](const std::string& name, const std::string& text,
                             const std::string& words) {
        if (!text.empty()) {
            put_bytes(archive.at(name), text);
        }
        const Outcome outcome = archive.run_to(2, name);
        CHECK_THAT(outcome.err, Contains(words));
        CHECK_FALSE(fs::exists(archive.at("results")));
    };
    refused("absent.csv", "", "There is no manifest or folder");
    refused("pairs.txt", "x", "neither a folder nor a file that ends in .csv");
    refused("a.csv", "name,left\nx,y\n", "names no column 'right'");
    refused("b.csv", "left,right\na.tif,b.tif,c.tif\n", "row 2 has 3 cells");
    refused("c.csv", "left,right\na/left.tif,b.tif\nb/left.tif,c.tif\n",
            "two pairs are named 'left'");
    refused("d.csv", "name,left,right\n../x,a.tif,b.tif\n", "cannot be the name of its output");
    refused("e.csv", "name,left,right,matcher.pathes\nx,a.tif,b.tif,8\n", "pathes");
    refused("f.csv", "left,right\n\"a.tif,b.tif\n", "quote");
    refused("g.yaml", "pairs:\n  - {left: a.tif, right: b.tif, sett: {}}\n", "'set'");
}

TEST_CASE("a batch that is interrupted stops its jobs and goes on with --resume")
{
    const Archive archive({500, 600});
    RunningProgram program(archive.command("pairs", {"--set", "matcher.disparity=[0,255]"}));
    REQUIRE(comes_true(
        [&] { return program.has_ended() || fs::exists(archive.at("results/east/work")); }));
    program.signal(SIGINT);
    const Outcome outcome = program.wait();
    CHECK(outcome.code == 130);
    archive.run_to(0, "pairs", {"--resume", "--set", "matcher.disparity=[0,255]"});
    CHECK_THAT(archive.text("results/summary.csv"),
               Contains("east,done,0,") && Contains("west,done,0,"));
}
