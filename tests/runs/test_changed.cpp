#include "tests/runs/run_place.h"

#include "tests/catch.h"

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;

namespace {

// A run of which some tiles are done.
struct Unfinished {
    RunPlace place = slow_place();
    Unfinished() { REQUIRE(place.run_and_kill(5) >= 5); }

    // Exit code 2, with each of `words` in one sentence, and nothing done.
    void refused(const std::vector<std::string>& options,
                 const std::vector<std::string>& words) const
    {
        const int done = place.done();
        const Outcome outcome = place.run_to(2, options);
        for (const std::string& word : words) {
            CHECK_THAT(outcome.err, Contains(word));
        }
        CHECK(place.done() == done);
    }
};

} // namespace

TEST_CASE("an unfinished run is neither begun anew nor gone on with unless that is asked for")
{
    const Unfinished run;
    run.refused({}, {"holds an unfinished run", "tiles done", "--resume", "--restart"});
    run.refused({"--resume", "--restart"}, {"give one of them"});
    run.place.run_to(0, {"--restart"});
    CHECK((run.place.rasters() == run.place.undisturbed()));
    CHECK(run.place.ledger().owners.size() == 1);
}

TEST_CASE("a run whose configuration has changed is not resumed, and says what differs")
{
    const Unfinished run;
    run.refused({"--resume", "--set", "matcher.p2=160"},
                {"cannot be resumed", "matcher.p2: 192 before, 160 now", "--restart"});
    run.refused({"--resume", "--set", "matcher.cost=census5x5", "--set", "matcher.median=off"},
                {"matcher.cost: ternary5x5 before, census5x5 now",
                 "matcher.median: 3 before, off now"});
    run.refused({"--resume", "--set", "geometry.height_per_px_m=0.5"},
                {"geometry.height_per_px_m: absent before, 0.5 now"});
    run.place.run_to(
        0, {"--resume", "--set", "run.order=reversed", "--set", "output.quicklooks=true"});
    CHECK((run.place.rasters() == run.place.undisturbed()));
}

TEST_CASE("a run whose images have changed is not resumed, and says which")
{
    const Unfinished run;
    const tiling::Size size = run.place.planned().shape.right;
    const std::string right = io::samples::bytes_of_file(run.place / "right.tif");
    Pixels pixels = shifted(noise(size), size, 5);
    pixels[pixels.size() / 2] += pixels[pixels.size() / 2] > 0 ? -1 : 1;
    make_raster(run.place / "right.tif", GDT_Byte, size, {pixels});
    run.refused({"--resume"}, {"right image pixels: checksum ", " before, checksum "});
    make_raster(run.place / "right.tif", GDT_Byte, {size.rows, size.cols + 1},
                {noise({size.rows, size.cols + 1}, 77)});
    run.refused({"--resume"}, {"right image size: 800 x 600 px before, 801 x 600 px now"});
    put_bytes(run.place / "right.tif", right);
    put_bytes(run.place / "elsewhere.tif", right);
    const Outcome resumed =
        run.place.run_to(0, {"--resume", "--set", "pair.right=elsewhere.tif"});
    CHECK_THAT(resumed.err, Contains("the images have been touched since"));
    CHECK((run.place.rasters() == run.place.undisturbed()));
}

TEST_CASE("images that nobody touched are not read again to resume")
{
    const Unfinished run;
    const Outcome resumed = run.place.run_to(0, {"--resume"});
    CHECK_THAT(resumed.err, !Contains("the images have been touched since"));
}

TEST_CASE("a finished run may be replaced by another")
{
    const RunPlace place({100, 120});
    place.run_to(0);
    const Snapshot before = place.rasters();
    place.run_to(2, {"--resume", "--set", "matcher.disparity=[0,9]"});
    CHECK((place.rasters() == before));
    place.run_to(0, {"--set", "matcher.disparity=[0,9]"});
    CHECK((place.rasters() != before));
}
