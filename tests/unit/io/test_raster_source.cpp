#include "io/error.h"
#include "io/raster_source.h"
#include "tests/unit/io/sample_rasters.h"

#include <limits>

using namespace hsgm::io;
using namespace hsgm::io::samples;
using Catch::Matchers::Contains;
using hsgm::tiling::Image;
using hsgm::tiling::Rect;
using hsgm::tiling::Size;

namespace {

std::vector<double> read_all(const ImageSpec& spec)
{
    RasterSource source(spec);
    Image<double> image(source.size());
    source.read(hsgm::tiling::rect_of(source.size()), image);
    return flat(image);
}

void colour(GDALDatasetH dataset)
{
    GDALSetRasterColorInterpretation(GDALGetRasterBand(dataset, 1), GCI_RedBand);
    GDALSetRasterColorInterpretation(GDALGetRasterBand(dataset, 2), GCI_GreenBand);
    GDALSetRasterColorInterpretation(GDALGetRasterBand(dataset, 3), GCI_BlueBand);
}

} // namespace

TEST_CASE("a window is read at its place, whatever the stride of the view")
{
    const std::string path = "/vsimem/io-window.tif";
    make_raster(path, GDT_UInt16, {3, 4}, {{0, 1, 2, 3, 10, 11, 12, 13, 20, 21, 22, 23}});
    RasterSource source({path});
    CHECK(source.size() == Size{3, 4});
    CHECK(source.pixel_type() == PixelType::uint16);
    CHECK(source.bands() == 1);
    CHECK(source.description() == path + ", band 1");
    Image<double> larger({4, 5}, 7.0);
    source.read({1, 2, 2, 2}, larger.view().part({1, 1, 2, 2}));
    CHECK(flat(larger) ==
          std::vector<double>{7, 7, 7, 7, 7, 7, 12, 13, 7, 7, 7, 22, 23, 7, 7, 7, 7, 7, 7, 7});
    VSIUnlink(path.c_str());
}

TEST_CASE("a tall window is read in strips that join without a gap")
{
    const std::string path = "/vsimem/io-tall.tif";
    std::vector<double> pixels(1000 * 2);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = static_cast<double>(i);
    }
    make_raster(path, GDT_Int32, {1000, 2}, {pixels}, {}, {"BLOCKYSIZE=48"});
    RasterSource source({path});
    Image<double> image({900, 2});
    source.read({37, 0, 900, 2}, image);
    CHECK(flat(image) == std::vector<double>(pixels.begin() + 74, pixels.begin() + 1874));
    VSIUnlink(path.c_str());
}

TEST_CASE("declared nodata, NaN and infinity have no value")
{
    const std::string path = "/vsimem/io-nodata.tif";
    const double inf = std::numeric_limits<double>::infinity();
    make_raster(path, GDT_Float32, {1, 5}, {{1.5, -9999, NAN, inf, -inf}}, [](GDALDatasetH d) {
        GDALSetRasterNoDataValue(GDALGetRasterBand(d, 1), -9999);
    });
    CHECK(read_all({path}) == std::vector<double>{1.5, -1, -1, -1, -1});
    VSIUnlink(path.c_str());
}

TEST_CASE("a sentinel with more digits than a float still marks its pixels")
{
    const std::string path = "/vsimem/io-sentinel.tif";
    make_raster(path, GDT_Float32, {1, 2}, {{0.1, 5}});
    CHECK(read_all({path, 0, 0.1}) == std::vector<double>{-1, 5});
    VSIUnlink(path.c_str());
}

TEST_CASE("a given nodata value replaces the declared one, and NaN switches it off")
{
    const std::string path = "/vsimem/io-given.tif";
    make_raster(path, GDT_Byte, {1, 3}, {{0, 7, 9}},
                [](GDALDatasetH d) { GDALSetRasterNoDataValue(GDALGetRasterBand(d, 1), 0); });
    CHECK(read_all({path}) == std::vector<double>{-1, 7, 9});
    CHECK(read_all({path, 1, 9}) == std::vector<double>{0, 7, -1});
    CHECK(read_all({path, 1, NAN}) == std::vector<double>{0, 7, 9});
    VSIUnlink(path.c_str());
}

TEST_CASE("red, green and blue become a luminance with the integer weights of OpenCV")
{
    const std::string path = "/vsimem/io-colour.tif";
    make_raster(path, GDT_Byte, {1, 4}, {{255, 0, 255, 10}, {0, 255, 255, 20}, {0, 0, 255, 31}},
                colour);
    // (255 * 4899 + 8192) >> 14 = 76; (255 * 9617 + 8192) >> 14 = 150;
    // (48990 + 192340 + 57908 + 8192) >> 14 = 307430 >> 14 = 18
    CHECK(read_all({path}) == std::vector<double>{76, 150, 255, 18});
    CHECK(RasterSource({path}).description() == path + ", luminance of bands 1-3");
    CHECK(read_all({path, 2}) == std::vector<double>{0, 255, 255, 20});
    VSIUnlink(path.c_str());
}

TEST_CASE("a colour pixel is absent only where all three bands hold nodata")
{
    const std::string path = "/vsimem/io-colour-nodata.tif";
    make_raster(path, GDT_UInt16, {1, 2}, {{0, 0}, {0, 1000}, {0, 0}}, [](GDALDatasetH d) {
        colour(d);
        GDALSetRasterNoDataValue(GDALGetRasterBand(d, 1), 0);
    });
    CHECK(read_all({path}) == std::vector<double>{-1, 587});
    VSIUnlink(path.c_str());
}

TEST_CASE("an alpha band of zero removes the pixel, also beside a nodata value")
{
    const std::string path = "/vsimem/io-alpha.tif";
    make_raster(path, GDT_Byte, {1, 3}, {{5, 6, 7}, {255, 0, 1}}, [](GDALDatasetH d) {
        GDALSetRasterColorInterpretation(GDALGetRasterBand(d, 2), GCI_AlphaBand);
        GDALSetRasterNoDataValue(GDALGetRasterBand(d, 1), 7);
    });
    CHECK(read_all({path}) == std::vector<double>{5, -1, -1});
    CHECK(read_all({path, 2}) == std::vector<double>{255, 0, 1});
    VSIUnlink(path.c_str());
}

TEST_CASE("the mask inside a file removes pixels")
{
    const std::string path = "/vsimem/io-inner-mask.tif";
    CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
    make_raster(path, GDT_Byte, {1, 3}, {{5, 6, 7}}, [](GDALDatasetH d) {
        REQUIRE(GDALCreateDatasetMaskBand(d, GMF_PER_DATASET) == CE_None);
        std::vector<std::uint8_t> mask{255, 0, 255};
        REQUIRE(GDALRasterIO(GDALGetMaskBand(GDALGetRasterBand(d, 1)), GF_Write, 0, 0, 3, 1,
                             mask.data(), 3, 1, GDT_Byte, 0, 0) == CE_None);
    });
    CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr);
    CHECK(read_all({path}) == std::vector<double>{5, -1, 7});
    VSIUnlink(path.c_str());
}

TEST_CASE("zeros of the mask file remove pixels")
{
    const std::string path = "/vsimem/io-image.tif";
    const std::string mask = "/vsimem/io-mask.tif";
    make_raster(path, GDT_Byte, {2, 2}, {{1, 2, 3, 4}});
    make_raster(mask, GDT_Byte, {2, 2}, {{0, 1, 255, 0}});
    CHECK(read_all({path, 0, {}, mask}) == std::vector<double>{-1, 2, 3, -1});
    make_raster(mask, GDT_Byte, {2, 3}, {{0, 0, 0, 0, 0, 0}});
    CHECK_THROWS_WITH(RasterSource({path, 0, {}, mask}),
                      Contains(mask) && Contains("2 rows x 3 columns") && Contains(path) &&
                          Contains("2 rows x 2 columns"));
    VSIUnlink(path.c_str());
    VSIUnlink(mask.c_str());
}

TEST_CASE("the ground position of a raster is given as stored")
{
    const std::string path = "/vsimem/io-geo.tif";
    const std::array<double, 6> transform{500000, 0.5, 0, 4600000, 0, -0.5};
    make_raster(path, GDT_Byte, {1, 1}, {{1}}, [&](GDALDatasetH d) {
        auto copy = transform;
        GDALSetGeoTransform(d, copy.data());
        GDALSetMetadataItem(d, "SENSOR", "test", nullptr);
    });
    RasterSource source({path});
    CHECK(source.geo_reference().transform == transform);
    CHECK(source.geo_reference().wkt.empty());
    CHECK(source.metadata("").at("SENSOR") == "test");
    CHECK(source.metadata("RPC").empty());
    make_raster(path, GDT_Byte, {1, 1}, {{1}});
    CHECK_FALSE(RasterSource({path}).geo_reference().transform.has_value());
    VSIUnlink(path.c_str());
}

TEST_CASE("a raster inside a zip archive is read in place")
{
    const std::string path = "/vsimem/io-inside.tif";
    make_raster(path, GDT_Byte, {1, 2}, {{3, 4}});
    const std::string zipped = "/vsizip/vsimem/io-archive.zip/inside.tif";
    put_bytes(zipped, bytes_of_file(path));
    CHECK(read_all({zipped}) == std::vector<double>{3, 4});
    VSIUnlink("/vsimem/io-archive.zip");
    VSIUnlink(path.c_str());
}

TEST_CASE("an unusable input is refused by name and reason")
{
    TemporaryFolder folder;
    CHECK_THROWS_AS(RasterSource({folder / "absent.tif"}), InputError);
    CHECK_THROWS_WITH(RasterSource({folder / "absent.tif"}),
                      Contains("no file") && Contains("absent.tif"));
    put_bytes(folder / "notes.tif", "these are words, not pixels");
    CHECK_THROWS_AS(RasterSource({folder / "notes.tif"}), InputError);
    CHECK_THROWS_WITH(RasterSource({folder / "notes.tif"}), Contains("not recognized"));
    put_bytes(folder / "empty.tif", "");
    CHECK_THROWS_AS(RasterSource({folder / "empty.tif"}), InputError);
    CHECK_THROWS_AS(RasterSource({folder.path().string()}), InputError);
    make_raster(folder / "complex.tif", GDT_CFloat32, {1, 1}, {{1}});
    CHECK_THROWS_AS(RasterSource({folder / "complex.tif"}), InputError);
    CHECK_THROWS_WITH(RasterSource({folder / "complex.tif"}), Contains("CFloat32"));
    make_raster(folder / "two.tif", GDT_Byte, {1, 1}, {{1}, {2}});
    CHECK_THROWS_AS(RasterSource({folder / "two.tif", 3}), InputError);
    CHECK_THROWS_WITH(RasterSource({folder / "two.tif", 3}),
                      Contains("has 2 bands") && Contains("no band 3"));
}

TEST_CASE("a file cut short fails where its pixels are missing, and says where")
{
    const std::string path = "/vsimem/io-whole.tif";
    std::vector<double> pixels(64 * 64);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = static_cast<double>(i * i % 251);
    }
    const auto compression = GENERATE(as<std::string>{}, "NONE", "DEFLATE");
    make_raster(path, GDT_Byte, {64, 64}, {pixels}, {},
                {"COMPRESS=" + compression, "BLOCKYSIZE=8"});
    const std::string bytes = bytes_of_file(path);
    put_bytes(path, bytes.substr(0, bytes.size() * 3 / 4));
    RasterSource source({path});
    Image<double> image({8, 64});
    CHECK_NOTHROW(source.read({0, 0, 8, 64}, image));
    CHECK_THROWS_AS(source.read({56, 0, 8, 64}, image), InputError);
    CHECK_THROWS_WITH(RasterSource(std::move(source)).read({56, 0, 8, 64}, image),
                      Contains("rows 56-63, columns 0-63") && Contains(path) &&
                          Contains("GDAL says"));
    VSIUnlink(path.c_str());
}

TEST_CASE("a JPEG cut short is an error, not a grey area")
{
    const std::string path = "/vsimem/io-photo.jpg";
    std::vector<double> pixels(128 * 128);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = static_cast<double>(i * 37 % 256);
    }
    make_raster("/vsimem/io-photo.tif", GDT_Byte, {128, 128}, {pixels});
    GDALDatasetH source = GDALOpen("/vsimem/io-photo.tif", GA_ReadOnly);
    GDALClose(GDALCreateCopy(GDALGetDriverByName("JPEG"), path.c_str(), source, FALSE, nullptr,
                             nullptr, nullptr));
    GDALClose(source);
    const std::string bytes = bytes_of_file(path);
    put_bytes(path, bytes.substr(0, bytes.size() / 2));
    RasterSource photo({path});
    Image<double> image({128, 128});
    CHECK_THROWS_AS(photo.read({0, 0, 128, 128}, image), InputError);
    VSIUnlink(path.c_str());
    VSIUnlink("/vsimem/io-photo.tif");
}

TEST_CASE("a window outside the image is refused")
{
    const std::string path = "/vsimem/io-outside.tif";
    make_raster(path, GDT_Byte, {2, 2}, {{1, 2, 3, 4}});
    RasterSource source({path});
    Image<double> image({2, 2});
    CHECK_THROWS_AS(source.read({1, 0, 2, 2}, image), InputError);
    CHECK_THROWS_AS(source.read({0, 0, 1, 2}, image), std::invalid_argument);
    VSIUnlink(path.c_str());
}
