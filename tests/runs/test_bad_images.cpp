#include "tests/faults/faulty_filesystem.h"
#include "tests/runs/run_place.h"

#include "io/error.h"

#include "tests/catch.h"

#include <algorithm>
#include <filesystem>

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;

namespace {

void compress(const RunPlace& place, const std::string& name)
{
    const tiling::Size size = place.planned().shape.left;
    const Pixels left = noise(size);
    make_raster(place / name, GDT_Byte, size,
                {name == "left.tif" ? left : shifted(left, size, 5)}, {},
                {"TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64", "COMPRESS=DEFLATE"});
}

// What a run must do with an image that it cannot read, beside the results of an earlier one.
void check_refused(const RunPlace& place, const std::string& image)
{
    const Snapshot before = place.rasters();
    const Outcome outcome = place.run_to(3, {"--restart"});
    CHECK_THAT(outcome.err, Contains(place / image) && Contains("GDAL says"));
    CHECK((place.rasters() == before));
    CHECK(place.tiles().empty());
    CHECK_FALSE(std::filesystem::exists(place.result() + "/work"));
}

} // namespace

TEST_CASE("a run whose source fails at its n-th read says so, and later gives the same bits")
{
    const RunPlace place;
    place.undisturbed();
    const pipeline::RunManner manner = place.manner();
    for (const bool left : {true, false}) {
        pipeline::PlannedJob planned = place.planned();
        std::string& path = left ? planned.job.left.path : planned.job.right.path;
        path = FaultyFilesystem::over(path);
        int reads = 0;
        {
            const FaultyFilesystem healthy;
            pipeline::run_job(planned, manner, {});
            reads = healthy.counts().reads;
        }
        REQUIRE(reads > 5);
        std::filesystem::remove_all(place.result());
        int refused = 0;
        for (int n = 1; n <= reads; n += std::max(1, reads / 7)) {
            INFO("read " << n << " of " << reads);
            std::filesystem::create_directories(place.result());
            try {
                const FaultyFilesystem faulty(FaultPlan{.fail_read = n});
                pipeline::run_job(planned, manner, {});
            } catch (const io::InputError& error) {
                ++refused;
                CHECK_THAT(error.what(), Contains(path));
                CHECK(place.rasters().empty());
                place.run_to(0, {"--resume"});
            }
            CHECK((place.rasters() == place.undisturbed()));
            std::filesystem::remove_all(place.result());
        }
        CHECK(refused > 0);
    }
}

TEST_CASE("a block in the middle of a TIFF that cannot be read ends a run, and can be mended")
{
    for (const char* image : {"left.tif", "right.tif"}) {
        const RunPlace place;
        compress(place, "left.tif");
        compress(place, "right.tif");
        place.run_to(0);
        CHECK((place.rasters() == place.undisturbed()));
        const std::string whole = io::samples::bytes_of_file(place / image);
        std::string spoilt = whole;
        std::fill_n(spoilt.begin() + static_cast<std::ptrdiff_t>(whole.size() / 2), 500,
                    '\xA5');
        put_bytes(place / image, spoilt);
        check_refused(place, image);
        put_bytes(place / image, whole.substr(0, whole.size() * 2 / 3)); // a transfer cut short
        check_refused(place, image);
        put_bytes(place / image, whole);
        place.run_to(0, {"--resume"});
        CHECK((place.rasters() == place.undisturbed()));
    }
}

TEST_CASE("an unfinished run outlives an image that cannot be read for a while")
{
    const RunPlace place = slow_place();
    const int done = place.run_and_kill(5);
    const std::string whole = io::samples::bytes_of_file(place / "left.tif");
    put_bytes(place / "left.tif", whole.substr(0, whole.size() / 2));
    const Outcome outcome = place.run_to(3, {"--resume"});
    CHECK_THAT(outcome.err, Contains(place / "left.tif"));
    CHECK(place.done() == done);
    put_bytes(place / "left.tif", whole);
    place.run_to(0, {"--resume"});
    CHECK((place.rasters() == place.undisturbed()));
}
