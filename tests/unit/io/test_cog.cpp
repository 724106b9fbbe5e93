// Cloud-optimized GeoTIFFs, judged by GDAL.

#include "io/cog.h"

#include "io/error.h"
#include "io/geotiff_writer.h"
#include "tests/unit/io/sample_rasters.h"

using namespace hsgm;
using namespace hsgm::io;
using samples::TemporaryFolder;

namespace {

constexpr tiling::Size kSize{700, 900};
constexpr float kNodata = -32768.0F;

/// Columns 0 1 2 3 ..., its left upper quarter without a value.
void write_ramp(const std::string& path)
{
    RasterOptions options;
    options.nodata = kNodata;
    options.geo.transform = {{1000, 0.5, 0, 2000, 0, -0.5}};
    options.metadata = {{"HSGM_MAP", "somewhere"}};
    options.band_descriptions = {"height"};
    options.unit = "metre";
    GeoTiffWriter writer(path, kSize, PixelType::float32, options);
    tiling::Image<float> pixels(kSize);
    for (int r = 0; r < kSize.rows; ++r) {
        for (int c = 0; c < kSize.cols; ++c) {
            pixels(r, c) = r < 350 && c < 450 ? kNodata : static_cast<float>(c);
        }
    }
    writer.write(rect_of(kSize), pixels);
    writer.finish();
}

/// Columns of 1 and 9 by turns: a mean of them would be 5.
void write_codes(const std::string& path)
{
    GeoTiffWriter writer(path, kSize, PixelType::uint8);
    tiling::Image<std::uint8_t> pixels(kSize);
    for (int r = 0; r < kSize.rows; ++r) {
        for (int c = 0; c < kSize.cols; ++c) {
            pixels(r, c) = c % 2 == 0 ? 1 : 9;
        }
    }
    writer.write(rect_of(kSize), pixels);
    writer.finish();
}

struct Opened {
    explicit Opened(const std::string& path)
        : dataset(GDALOpen(path.c_str(), GA_ReadOnly)), band(GDALGetRasterBand(dataset, 1))
    {
    }
    ~Opened() { GDALClose(dataset); }
    Opened(const Opened&) = delete;
    Opened& operator=(const Opened&) = delete;

    std::vector<float> pixels(GDALRasterBandH from) const
    {
        const int cols = GDALGetRasterBandXSize(from);
        const int rows = GDALGetRasterBandYSize(from);
        std::vector<float> values(static_cast<std::size_t>(cols) *
                                  static_cast<std::size_t>(rows));
        REQUIRE(GDALRasterIO(from, GF_Read, 0, 0, cols, rows, values.data(), cols, rows,
                             GDT_Float32, 0, 0) == CE_None);
        return values;
    }
    std::string item(const char* name, const char* domain) const
    {
        const char* value = GDALGetMetadataItem(dataset, name, domain);
        return value == nullptr ? "" : value;
    }
    GDALDatasetH dataset;
    GDALRasterBandH band;
};

} // namespace

TEST_CASE("a raster made cloud-optimized keeps all that it had")
{
    const TemporaryFolder folder;
    const std::string path = folder / "ramp.tif";
    write_ramp(path);
    const std::vector<float> before = [&] {
        const Opened plain(path);
        CHECK(plain.item("LAYOUT", "IMAGE_STRUCTURE").empty());
        return plain.pixels(plain.band);
    }();
    make_cloud_optimized(path);
    const Opened cog(path);
    CHECK(cog.item("LAYOUT", "IMAGE_STRUCTURE") == "COG");
    CHECK(cog.pixels(cog.band) == before);
    CHECK(cog.item("HSGM_MAP", "") == "somewhere");
    CHECK(std::string(GDALGetDescription(cog.band)) == "height");
    CHECK(std::string(GDALGetRasterUnitType(cog.band)) == "metre");
    int has = 0;
    CHECK(GDALGetRasterNoDataValue(cog.band, &has) == double{kNodata});
    CHECK(has != 0);
    double transform[6] = {};
    REQUIRE(GDALGetGeoTransform(cog.dataset, transform) == CE_None);
    CHECK(transform[0] == 1000);
    CHECK(transform[5] == -0.5);
    CHECK(folder.names() == std::vector<std::string>{"ramp.tif"});
}

TEST_CASE("statistics and overviews of a cloud-optimized raster leave out what has no value")
{
    const TemporaryFolder folder;
    const std::string path = folder / "ramp.tif";
    write_ramp(path);
    make_cloud_optimized(path);
    const Opened cog(path);
    double low = 0;
    double high = 0;
    double mean = 0;
    double deviation = 0;
    // Stored ones: FALSE forbids to compute any.
    REQUIRE(GDALGetRasterStatistics(cog.band, FALSE, FALSE, &low, &high, &mean, &deviation) ==
            CE_None);
    CHECK(low == 0);
    CHECK(high == 899);
    REQUIRE(GDALGetOverviewCount(cog.band) >= 1);
    const auto coarse = cog.pixels(GDALGetOverview(cog.band, 0));
    CHECK(coarse.front() == kNodata);
    CHECK(coarse.back() == 898.5F); // the mean of 898 and 899
}

TEST_CASE("overviews of codes hold codes, and no mean of them")
{
    const TemporaryFolder folder;
    for (const auto& [overviews, has_means] :
         {std::pair{Overviews::nearest, false}, std::pair{Overviews::mean, true}}) {
        const std::string path = folder / "codes.tif";
        write_codes(path);
        make_cloud_optimized(path, {}, overviews);
        const Opened cog(path);
        const auto coarse = cog.pixels(GDALGetOverview(cog.band, 0));
        const bool found = std::any_of(coarse.begin(), coarse.end(),
                                       [](float value) { return value != 1 && value != 9; });
        CHECK(found == has_means);
    }
}

TEST_CASE("cloud-optimized rasters take the creation options that they share with plain ones")
{
    const TemporaryFolder folder;
    const std::string path = folder / "ramp.tif";
    write_ramp(path);
    make_cloud_optimized(path, {"COMPRESS=LZW", "BLOCKXSIZE=128", "TILED=YES"});
    const Opened cog(path);
    CHECK(cog.item("COMPRESSION", "IMAGE_STRUCTURE") == "LZW");
    int width = 0;
    int height = 0;
    GDALGetBlockSize(cog.band, &width, &height);
    CHECK(width == 512);
}

TEST_CASE("the same raster becomes the same cloud-optimized bytes")
{
    const TemporaryFolder folder;
    for (const char* name : {"a.tif", "b.tif"}) {
        write_ramp(folder / name);
        make_cloud_optimized(folder / name);
    }
    CHECK(samples::bytes_of_file(folder / "a.tif") == samples::bytes_of_file(folder / "b.tif"));
}

TEST_CASE("what cannot become cloud-optimized is refused, and leaves nothing")
{
    const TemporaryFolder folder;
    CHECK_THROWS_AS(make_cloud_optimized(folder / "none.tif"), InputError);
    samples::put_bytes(folder / "text.tif", "hello");
    CHECK_THROWS_AS(make_cloud_optimized(folder / "text.tif"), InputError);
    CHECK(folder.names() == std::vector<std::string>{"text.tif"});
    CHECK(samples::bytes_of_file(folder / "text.tif") == "hello");
}
