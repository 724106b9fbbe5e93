#include "io/error.h"
#include "io/pending_file.h"
#include "io/stored_blocks.h"
#include "tests/unit/io/sample_rasters.h"

using namespace hsgm::io;
using namespace hsgm::io::samples;
using Catch::Matchers::Contains;

namespace {

const std::vector<std::string> kTiles{"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"};

/// A tiled raster of 48 x 48 pixels under the temporary name of a pending file.
void make_pending(const PendingFile& file)
{
    make_raster(file.temporary_path(), GDT_Byte, {48, 48}, {std::vector<double>(48 * 48, 5)},
                {}, kTiles);
}

} // namespace

TEST_CASE("a whole file passes, one of another size or type does not")
{
    const PendingFile file("/vsimem/io-blocks.tif");
    make_pending(file);
    CHECK_NOTHROW(check_stored_blocks(file, {48, 48}, PixelType::uint8, false));
    CHECK_THROWS_AS(check_stored_blocks(file, {48, 47}, PixelType::uint8, false), StorageError);
    CHECK_THROWS_AS(check_stored_blocks(file, {48, 48}, PixelType::int16, false), StorageError);
}

TEST_CASE("a block that was never stored is missed, unless blocks may be left out")
{
    const PendingFile file("/vsimem/io-blocks.tif");
    std::vector<std::string> options = kTiles;
    options.push_back("SPARSE_OK=TRUE");
    std::vector<double> pixels(48 * 48, 0); // blocks of nothing but zeros are left out
    pixels.front() = 1;
    pixels.back() = 1;
    make_raster(file.temporary_path(), GDT_Byte, {48, 48}, {pixels}, {}, options);
    CHECK_NOTHROW(check_stored_blocks(file, {48, 48}, PixelType::uint8, true));
    CHECK_THROWS_WITH(check_stored_blocks(file, {48, 48}, PixelType::uint8, false),
                      Contains("io-blocks.tif") && Contains("block 1, 0 is missing"));
}

TEST_CASE("a file whose end is gone is missed, even where its first and last blocks are not")
{
    const PendingFile file("/vsimem/io-blocks.tif");
    make_pending(file);
    const std::string bytes = bytes_of_file(file.temporary_path());
    put_bytes(file.temporary_path(), bytes.substr(0, bytes.size() - 1));
    CHECK_THROWS_WITH(check_stored_blocks(file, {48, 48}, PixelType::uint8, true),
                      Contains("is missing from it"));
    put_bytes(file.temporary_path(), bytes.substr(0, 4));
    CHECK_THROWS_WITH(check_stored_blocks(file, {48, 48}, PixelType::uint8, true),
                      Contains("cannot be opened again"));
}
