#include "io/error.h"
#include "io/geotiff_writer.h"
#include "io/pending_file.h"
#include "io/raster_source.h"
#include "tests/unit/io/sample_rasters.h"

#include <chrono>
#include <cstdint>

using namespace hsgm::io;
using namespace hsgm::io::samples;
using Catch::Matchers::Contains;
using hsgm::tiling::Image;
using hsgm::tiling::ImageView;
using hsgm::tiling::Rect;
using hsgm::tiling::Size;

namespace {

template <typename T>
Image<T> pattern(Size size)
{
    Image<T> image(size);
    for (int r = 0; r < size.rows; ++r) {
        for (int c = 0; c < size.cols; ++c) {
            image(r, c) = static_cast<T>((r * 31 + c * 7) % 97);
        }
    }
    return image;
}

/// Writes `image` in tiles of `tile` pixels a side, row by row or backwards.
template <typename T>
void write_in_tiles(GeoTiffWriter& writer, const Image<T>& image, int tile, bool backwards)
{
    std::vector<Rect> tiles;
    for (int row = 0; row < image.rows(); row += tile) {
        for (int col = 0; col < image.cols(); col += tile) {
            tiles.push_back(hsgm::tiling::intersect({row, col, tile, tile},
                                                    hsgm::tiling::rect_of(image.size())));
        }
    }
    if (backwards) {
        std::reverse(tiles.begin(), tiles.end());
    }
    for (const Rect& part : tiles) {
        writer.write(part, image.view().part(part));
    }
}

std::vector<double> read_all(const std::string& path)
{
    RasterSource source({path, 1});
    Image<double> image(source.size());
    source.read(hsgm::tiling::rect_of(source.size()), image);
    return flat(image);
}

template <typename T>
std::vector<double> as_doubles(const Image<T>& image)
{
    return {image.pixels().begin(), image.pixels().end()};
}

} // namespace

TEMPLATE_TEST_CASE("pixels of every type come back as written", "", std::uint8_t, std::uint16_t,
                   std::int16_t, std::uint32_t, std::int32_t, float, double)
{
    const std::string path = "/vsimem/io-written.tif";
    const Image<TestType> image = pattern<TestType>({300, 530});
    const int tile = GENERATE(64, 100, 256, 1000);
    const bool backwards = GENERATE(false, true);
    GeoTiffWriter writer(path, image.size(), pixel_type_of<TestType>());
    write_in_tiles(writer, image, tile, backwards);
    CHECK(writer.pending_bytes() == 0);
    writer.finish();
    CHECK(RasterSource({path}).pixel_type() == pixel_type_of<TestType>());
    CHECK(read_all(path) == as_doubles(image));
    VSIUnlink(path.c_str());
}

TEST_CASE("the file says where it lies, what it means and what is missing")
{
    const std::string path = "/vsimem/io-described.tif";
    RasterOptions options;
    options.nodata = -32768;
    options.geo.transform = {{400000, 0.5, 0, 5000000, 0, -0.5}};
    options.geo.wkt =
        "LOCAL_CS[\"site grid\",UNIT[\"metre\",1],AXIS[\"Easting\",EAST],AXIS[\"Northing\","
        "NORTH]]";
    options.metadata = {{"HSGM_DATUM", "WGS 84 ellipsoid"}, {"HSGM_VERSION", "0.1.0"}};
    options.band_descriptions = {"height"};
    options.unit = "metre";
    GeoTiffWriter writer(path, {2, 2}, PixelType::float32, options);
    Image<float> row({1, 2}, 12.5F);
    writer.write(Rect{0, 0, 1, 2}, ImageView<const float>(row));
    writer.finish();
    RasterSource source({path});
    CHECK(source.geo_reference().transform == options.geo.transform);
    CHECK_THAT(source.geo_reference().wkt, Contains("site grid"));
    CHECK(source.metadata("").at("HSGM_DATUM") == "WGS 84 ellipsoid");
    CHECK(read_all(path) == std::vector<double>{12.5, 12.5, -1, -1});
    GDALDatasetH dataset = GDALOpen(path.c_str(), GA_ReadOnly);
    GDALRasterBandH band = GDALGetRasterBand(dataset, 1);
    CHECK(GDALGetRasterNoDataValue(band, nullptr) == -32768);
    CHECK(std::string(GDALGetDescription(band)) == "height");
    CHECK(std::string(GDALGetRasterUnitType(band)) == "metre");
    GDALClose(dataset);
    VSIUnlink(path.c_str());
}

TEST_CASE("an unfinished output leaves the earlier one and no temporary file")
{
    TemporaryFolder folder;
    put_bytes(folder / "dsm.tif", "the earlier result");
    {
        GeoTiffWriter writer(folder / "dsm.tif", {300, 300}, PixelType::uint8);
        const Image<std::uint8_t> image = pattern<std::uint8_t>({300, 300});
        writer.write(Rect{0, 0, 300, 300}, image.view());
        CHECK(folder.names().size() == 2);
        CHECK_THAT(folder.names().front(), Catch::Matchers::StartsWith(".dsm.part-"));
        CHECK(bytes_of_file(folder / "dsm.tif") == "the earlier result");
    }
    CHECK(folder.names() == std::vector<std::string>{"dsm.tif"});
    CHECK(bytes_of_file(folder / "dsm.tif") == "the earlier result");
}

TEST_CASE("a finished output replaces the earlier one and its stale side files")
{
    TemporaryFolder folder;
    put_bytes(folder / "dsm.tif", "the earlier result");
    put_bytes(folder / "dsm.tif.aux.xml", "statistics of the earlier result");
    const Image<std::uint8_t> image = pattern<std::uint8_t>({3, 3});
    GeoTiffWriter writer(folder / "dsm.tif", {3, 3}, PixelType::uint8);
    writer.write(Rect{0, 0, 3, 3}, image.view());
    writer.finish();
    CHECK(folder.names() == std::vector<std::string>{"dsm.tif"});
    CHECK(read_all(folder / "dsm.tif") == as_doubles(image));
    CHECK_THROWS_AS(writer.finish(), std::logic_error);
}

TEST_CASE("the same order of writes gives the same bytes, whatever the cache does")
{
    const Image<float> image = pattern<float>({600, 700});
    std::vector<std::string> files;
    const GIntBig cache = GDALGetCacheMax64();
    for (const GIntBig cache_bytes : {GIntBig{1}, GIntBig{64 << 20}}) {
        GDALSetCacheMax64(cache_bytes);
        GeoTiffWriter writer("/vsimem/io-same.tif", image.size(), PixelType::float32);
        write_in_tiles(writer, image, 256, false);
        writer.finish();
        files.push_back(bytes_of_file("/vsimem/io-same.tif"));
    }
    GDALSetCacheMax64(cache);
    CHECK(files[0] == files[1]);
    VSIUnlink("/vsimem/io-same.tif");
}

TEST_CASE("tiles and compression are the defaults, and each may be overridden")
{
    const std::string path = "/vsimem/io-options.tif";
    const auto structure = [&](const RasterOptions& options, const char* key) {
        GeoTiffWriter writer(path, {20, 600}, PixelType::uint16, options);
        writer.finish();
        GDALDatasetH dataset = GDALOpen(path.c_str(), GA_ReadOnly);
        const char* value = GDALGetMetadataItem(dataset, key, "IMAGE_STRUCTURE");
        const std::string text = value == nullptr ? "" : value;
        GDALClose(dataset);
        return text;
    };
    CHECK(
        (structure({}, "COMPRESSION") == "ZSTD" || structure({}, "COMPRESSION") == "DEFLATE"));
    CHECK(structure({}, "PREDICTOR") == "2");
    CHECK(RasterSource({path}).block_size() == Size{256, 256});
    RasterOptions options;
    options.creation_options = {"compress=LZW", "BLOCKXSIZE=64", "BLOCKYSIZE=32"};
    CHECK(structure(options, "COMPRESSION") == "LZW");
    CHECK(RasterSource({path}).block_size() == Size{32, 64});
    options.creation_options = {"COMPRESS=NONE", "TILED=NO"};
    CHECK(structure(options, "COMPRESSION").empty());
    CHECK(RasterSource({path}).block_size().cols == 600);
    options.creation_options = {"SPARSE_OK=TRUE"};
    CHECK_NOTHROW(structure(options, "COMPRESSION"));
    VSIUnlink(path.c_str());
}

TEST_CASE("a creation option that GDAL refuses is the user's mistake, named")
{
    TemporaryFolder folder;
    const auto attempt = [&](const std::string& option) {
        RasterOptions options;
        options.creation_options = {option};
        GeoTiffWriter(folder / "x.tif", {20, 20}, PixelType::uint8, options);
    };
    CHECK_THROWS_AS(attempt("COMPRES=LZW"), ConfigError);
    CHECK_THROWS_WITH(attempt("COMPRES=LZW"), Contains("COMPRES") && Contains("x.tif"));
    CHECK_THROWS_AS(attempt("COMPRESS=FAST"), ConfigError);
    CHECK_THROWS_WITH(attempt("COMPRESS=FAST"), Contains("FAST"));
    CHECK_THROWS_AS(attempt("LZW"), ConfigError);
    CHECK_THROWS_WITH(attempt("LZW"), Contains("KEY=VALUE"));
    CHECK_THROWS_AS(attempt("BLOCKXSIZE=100"), ConfigError);
    CHECK_THROWS_AS(attempt("PREDICTOR=3"), ConfigError);
    CHECK(folder.names().empty());
}

TEST_CASE("a missing folder is reported before the first pixel")
{
    TemporaryFolder folder;
    const auto attempt = [&] { GeoTiffWriter(folder / "no/x.tif", {1, 1}, PixelType::uint8); };
    CHECK_THROWS_AS(attempt(), StorageError);
    CHECK_THROWS_WITH(attempt(), Contains("there is no folder") && Contains("/no"));
}

TEST_CASE("a pixel that comes twice, or outside, is a bug that is caught")
{
    GeoTiffWriter writer("/vsimem/io-twice.tif", {300, 300}, PixelType::uint8);
    const Image<std::uint8_t> image({256, 256});
    writer.write(Rect{0, 0, 256, 256}, image.view()); // a whole block: stored at once
    writer.write(Rect{256, 0, 10, 10}, image.view().part({0, 0, 10, 10})); // waits
    const ImageView<const std::uint8_t> pixel = image.view().part({0, 0, 1, 1});
    CHECK_THROWS_AS(writer.write(Rect{5, 5, 1, 1}, pixel), std::logic_error);
    CHECK_THROWS_AS(writer.write(Rect{265, 9, 1, 1}, pixel), std::logic_error);
    CHECK_THROWS_AS(writer.write(Rect{300, 0, 1, 1}, pixel), std::logic_error);
    CHECK_THROWS_AS(writer.write(Rect{299, 0, 2, 1}, pixel), std::logic_error);
    Image<float> wrong({1, 1});
    CHECK_THROWS_AS(writer.write(Rect{290, 290, 1, 1}, ImageView<const float>(wrong)),
                    std::logic_error);
    CHECK_NOTHROW(writer.write(Rect{266, 9, 1, 1}, pixel));
    CHECK(writer.pending_bytes() == 256 * 256);
}

TEST_CASE("abandoning a large output takes no time and no room")
{
    TemporaryFolder folder;
    const auto start = std::chrono::steady_clock::now();
    {
        RasterOptions options;
        options.creation_options = {"COMPRESS=DEFLATE"};
        GeoTiffWriter writer(folder / "huge.tif", {40000, 40000}, PixelType::float32, options);
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    CHECK(seconds.count() < 2);
    CHECK(folder.names().empty());
}

TEST_CASE("a text file appears whole and replaces its predecessor")
{
    TemporaryFolder folder;
    write_text_file(folder / "run.json", "{}\n");
    write_text_file(folder / "run.json", "{\"a\": 1}\n");
    CHECK(bytes_of_file(folder / "run.json") == "{\"a\": 1}\n");
    CHECK(folder.names() == std::vector<std::string>{"run.json"});
    CHECK_THROWS_AS(write_text_file(folder / "no/run.json", ""), StorageError);
    CHECK_THROWS_AS(write_text_file(folder.path().string(), ""), StorageError);
}
