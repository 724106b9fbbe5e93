#include "io/error.h"
#include "io/raster_source.h"
#include "tests/faults/faulty_filesystem.h"
#include "tests/unit/io/sample_rasters.h"

using namespace hsgm::io;
using namespace hsgm::io::samples;
using Catch::Matchers::Contains;
using hsgm::tests::FaultPlan;
using hsgm::tests::FaultyFilesystem;
using hsgm::tiling::Image;

namespace {

const std::string kInner = "/vsimem/faults-input.tif";

std::vector<double> sample_pixels()
{
    std::vector<double> pixels(200 * 100);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = static_cast<double>(i * 7 % 251);
    }
    return pixels;
}

std::vector<double> read_all(const std::string& path)
{
    RasterSource source({path});
    Image<double> image(source.size());
    source.read(hsgm::tiling::rect_of(source.size()), image);
    return flat(image);
}

} // namespace

TEST_CASE("whichever read fails, the pixels are right or there is an error")
{
    const std::vector<double> pixels = sample_pixels();
    const auto compression = GENERATE(as<std::string>{}, "NONE", "DEFLATE");
    make_raster(kInner, GDT_Byte, {200, 100}, {pixels}, {},
                {"TILED=YES", "BLOCKXSIZE=32", "BLOCKYSIZE=32", "COMPRESS=" + compression});
    int reads = 0;
    {
        const FaultyFilesystem healthy;
        CHECK(read_all(FaultyFilesystem::over(kInner)) == pixels);
        reads = healthy.counts().reads;
    }
    REQUIRE(reads > 10);
    int errors = 0;
    for (int n = 1; n <= reads; ++n) {
        const FaultyFilesystem faulty(FaultPlan{.fail_read = n});
        try {
            const std::vector<double> found = read_all(FaultyFilesystem::over(kInner));
            CHECK((found == pixels));
        } catch (const InputError& error) {
            ++errors;
            CHECK_THAT(error.what(), Contains(kInner) && Contains("GDAL says"));
        }
    }
    CHECK(errors > reads / 2);
    VSIUnlink(kInner.c_str());
}

TEST_CASE("whichever read fails, the same source reads the right pixels when asked again")
{
    const std::vector<double> pixels = sample_pixels();
    make_raster(kInner, GDT_Byte, {200, 100}, {pixels}, {},
                {"TILED=YES", "BLOCKXSIZE=32", "BLOCKYSIZE=32"});
    int failures = 0;
    for (int n = 1; n <= 40; ++n) {
        INFO("read " << n << " after opening");
        const FaultyFilesystem healthy;
        RasterSource source({FaultyFilesystem::over(kInner)});
        Image<double> image(source.size());
        const FaultyFilesystem faulty(FaultPlan{.fail_read = n});
        try {
            source.read({0, 0, 200, 100}, image);
        } catch (const InputError&) {
            ++failures;
            source.read({0, 0, 200, 100}, image);
        }
        CHECK((flat(image) == pixels));
    }
    CHECK(failures > 20);
    VSIUnlink(kInner.c_str());
}
