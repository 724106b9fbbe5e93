#include "io/error.h"
#include "io/geotiff_writer.h"
#include "io/hillshade.h"
#include "io/pending_file.h"
#include "io/png.h"
#include "tests/faults/faulty_filesystem.h"
#include "tests/unit/io/sample_rasters.h"

#include <functional>
#include <random>

using namespace hsgm::io;
using namespace hsgm::io::samples;
using Catch::Matchers::Contains;
using hsgm::tests::FaultCounts;
using hsgm::tests::FaultPlan;
using hsgm::tests::FaultyFilesystem;
using hsgm::tiling::Image;

namespace {

const char* const kEarlier = "the earlier result";

using Write = std::function<void(const std::string& path)>;

void write_geotiff(const std::string& path)
{
    Image<std::uint16_t> image({300, 300});
    std::mt19937 noise(1); // does not compress
    for (int r = 0; r < 300; ++r) {
        std::generate_n(image.row(r), 300, [&] { return static_cast<std::uint16_t>(noise()); });
    }
    GeoTiffWriter writer(path, image.size(), PixelType::uint16);
    writer.write({0, 0, 300, 300}, image.view());
    writer.finish();
}

void write_picture(const std::string& path)
{
    const Image<std::uint8_t> gray({40, 40}, 9);
    write_png(path, gray.view());
}

void write_text(const std::string& path)
{
    write_text_file(path, "{\"tiles\": 4}\n");
}

void write_shade(const std::string& path)
{
    write_hillshade("/vsimem/faults-height.tif", path);
}

struct Output {
    std::string name;
    Write write;
};

/// The writers, each tried with every fault.
Output each_output()
{
    make_raster("/vsimem/faults-height.tif", GDT_Float32, {3, 3},
                {{1, 2, 3, 4, 5, 6, 7, 8, 9}});
    return GENERATE(values<Output>({{"x.tif", write_geotiff},
                                    {"x.png", write_picture},
                                    {"x.json", write_text},
                                    {"shade.tif", write_shade}}));
}

/// Runs one write under a plan: it must fail as a storage error, leave the earlier output as
/// it was, and no other file.
void check_harmless(const Output& output, const FaultPlan& plan)
{
    TemporaryFolder folder;
    put_bytes(folder / output.name, kEarlier);
    {
        const FaultyFilesystem faulty(plan);
        CHECK_THROWS_AS(output.write(FaultyFilesystem::over(folder / output.name)),
                        StorageError);
    }
    CHECK((bytes_of_file(folder / output.name) == kEarlier));
    CHECK(folder.names() == std::vector<std::string>{output.name});
}

FaultCounts count(const Output& output)
{
    TemporaryFolder folder;
    const FaultyFilesystem healthy;
    output.write(FaultyFilesystem::over(folder / output.name));
    CHECK(folder.names() == std::vector<std::string>{output.name});
    return healthy.counts();
}

} // namespace

TEST_CASE("whichever write fails, the earlier output stays and nothing else does")
{
    const Output output = each_output();
    const FaultCounts counts = count(output);
    REQUIRE(counts.writes > 0);
    for (int n = 1; n <= counts.writes; ++n) {
        INFO(output.name << ", write " << n << " of " << counts.writes);
        check_harmless(output, {.fail_write = n});
    }
}

TEST_CASE("wherever the disk fills up, the earlier output stays and nothing else does")
{
    const Output output = each_output();
    const std::int64_t bytes = count(output).bytes;
    for (const std::int64_t room :
         {std::int64_t{0}, std::int64_t{1}, bytes / 4, bytes / 2, bytes * 3 / 4, bytes - 1}) {
        INFO(output.name << ", room for " << room << " of " << bytes);
        check_harmless(output, {.room_bytes = room});
    }
}

TEST_CASE("whichever opening fails, the earlier output stays and nothing else does")
{
    const Output output = each_output();
    for (int n = 1; n <= count(output).opens; ++n) {
        INFO(output.name << ", opening " << n);
        check_harmless(output, {.fail_open = n});
    }
}

TEST_CASE("a failing close is noticed, or the file is provably whole")
{
    const Output output = each_output();
    for (int n = 1; n <= count(output).closes; ++n) {
        INFO(output.name << ", closing " << n);
        TemporaryFolder folder;
        put_bytes(folder / output.name, kEarlier);
        bool failed = false;
        {
            const FaultyFilesystem faulty(FaultPlan{.fail_close = n});
            try {
                output.write(FaultyFilesystem::over(folder / output.name));
            } catch (const StorageError&) {
                failed = true;
            }
        }
        CHECK(failed == (bytes_of_file(folder / output.name) == kEarlier));
        CHECK(folder.names() == std::vector<std::string>{output.name});
    }
}

TEST_CASE("a failing rename leaves the earlier output and no temporary file")
{
    check_harmless(each_output(), {.fail_rename = true});
}

TEST_CASE("the message names the file, GDAL's words and the full disk")
{
    TemporaryFolder folder;
    const FaultyFilesystem faulty(FaultPlan{.room_bytes = 5000});
    CHECK_THROWS_WITH(write_geotiff(FaultyFilesystem::over(folder / "x.tif")),
                      Contains("x.tif") && Contains("GDAL says") &&
                          Contains("No space left on device"));
}
