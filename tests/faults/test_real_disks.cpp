#include "io/error.h"
#include "io/geotiff_writer.h"
#include "io/png.h"
#include "io/scratch_folder.h"
#include "io/scratch_raster.h"
#include "tests/faults/small_disk.h"
#include "tests/unit/io/sample_rasters.h"

#include <iostream>
#include <random>

using namespace hsgm::io;
using namespace hsgm::io::samples;
using Catch::Matchers::Contains;
using hsgm::tests::SmallDisk;
using hsgm::tiling::Image;

namespace {

void write_noise(const std::string& path, int side, const std::string& compression)
{
    RasterOptions options;
    options.creation_options = {"COMPRESS=" + compression};
    Image<std::uint32_t> image({side, side});
    std::mt19937 noise(1);
    for (int r = 0; r < side; ++r) {
        std::generate_n(image.row(r), side, std::ref(noise));
    }
    GeoTiffWriter writer(path, image.size(), PixelType::uint32, options);
    writer.write({0, 0, side, side}, image.view());
    writer.finish();
}

} // namespace

TEST_CASE("a raster too large for the disk leaves the earlier one and no temporary file")
{
    SmallDisk disk;
    if (!disk.mounted()) {
        return;
    }
    const std::string path = disk.folder() / "x.tif";
    put_bytes(path, "the earlier result");
    const auto compression = GENERATE(as<std::string>{}, "NONE", "DEFLATE");
    // 600: far too large. 512: its pixels alone are 1 MiB, so the last bytes do not fit.
    const int side = GENERATE(600, 512);
    CHECK_THROWS_AS(write_noise(path, side, compression), StorageError);
    CHECK_THROWS_WITH(write_noise(path, side, compression), Contains(path));
    CHECK((bytes_of_file(path) == "the earlier result"));
    CHECK(disk.folder().names() == std::vector<std::string>{"x.tif"});
    CHECK_NOTHROW(write_noise(disk.folder() / "small.tif", 100, compression));
}

TEST_CASE("a scratch raster that does not fit is refused when it is made")
{
    SmallDisk disk;
    if (!disk.mounted()) {
        return;
    }
    const auto attempt = [&](float fill) {
        ScratchRaster<float>(disk.folder().path(), "x", {1024, 1024}, fill);
    };
    for (const float fill : {0.0F, 1.0F}) {
        CHECK_THROWS_AS(attempt(fill), StorageError);
        CHECK_THROWS_WITH(attempt(fill), Contains("needs 4194304 bytes") &&
                                             Contains("1048576 are free") &&
                                             Contains("No space left on device"));
    }
    CHECK(disk.folder().names().empty());
    CHECK_NOTHROW(ScratchRaster<float>(disk.folder().path(), "x", {256, 256}, 1.0F));
}

TEST_CASE("a disk that may not be written to is reported before the first pixel")
{
    SmallDisk disk;
    if (!disk.mounted()) {
        return;
    }
    disk.make_read_only();
    const auto attempt = [&] {
        GeoTiffWriter(disk.folder() / "x.tif", {1, 1}, PixelType::uint8);
    };
    CHECK_THROWS_AS(attempt(), StorageError);
    CHECK_THROWS_WITH(attempt(), Contains("takes no new file (Read-only file system)"));
    CHECK_THROWS_AS(write_png(disk.folder() / "x.png", Image<std::uint8_t>({1, 1}).view()),
                    StorageError);
    CHECK_THROWS_AS(ScratchFolder(disk.folder().path()), StorageError);
}
