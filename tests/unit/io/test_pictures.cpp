#include "io/colour_map.h"
#include "io/error.h"
#include "io/hillshade.h"
#include "io/png.h"
#include "io/quicklook.h"
#include "io/raster_source.h"
#include "tests/unit/io/sample_rasters.h"

using namespace hsgm::io;
using namespace hsgm::io::samples;
using Catch::Matchers::Contains;
using hsgm::tiling::Image;
using hsgm::tiling::Size;

namespace {

std::vector<double> read_band(const std::string& path, int band)
{
    RasterSource source({path, band});
    Image<double> image(source.size());
    source.read(hsgm::tiling::rect_of(source.size()), image);
    return flat(image);
}

/// Heights on a grid of 1 m that fall by `per_col` metres with every column to the east.
void make_slope(const std::string& path, double per_col, Size size)
{
    std::vector<double> heights;
    for (int r = 0; r < size.rows; ++r) {
        for (int c = 0; c < size.cols; ++c) {
            heights.push_back(100 - per_col * c);
        }
    }
    make_raster(path, GDT_Float32, size, {heights}, [](GDALDatasetH d) {
        double transform[] = {0, 1, 0, 0, 0, -1};
        GDALSetGeoTransform(d, transform);
        GDALSetRasterNoDataValue(GDALGetRasterBand(d, 1), -32768);
    });
}

} // namespace

TEST_CASE("a grey and a coloured PNG hold exactly their pixels, and nothing lies beside them")
{
    TemporaryFolder folder;
    Image<std::uint8_t> gray({2, 3});
    gray(0, 1) = 100;
    gray(1, 2) = 255;
    write_png(folder / "gray.png", gray.view());
    CHECK(read_band(folder / "gray.png", 1) == std::vector<double>{0, 100, 0, 0, 0, 255});
    Image<Rgb> colour({1, 2}, Rgb{1, 2, 3});
    colour(0, 1) = {250, 251, 252};
    write_png(folder / "colour.png", colour.view());
    CHECK(RasterSource({folder / "colour.png"}).bands() == 3);
    CHECK(read_band(folder / "colour.png", 1) == std::vector<double>{1, 250});
    CHECK(read_band(folder / "colour.png", 2) == std::vector<double>{2, 251});
    CHECK(read_band(folder / "colour.png", 3) == std::vector<double>{3, 252});
    CHECK(folder.names() == std::vector<std::string>{"colour.png", "gray.png"});
    CHECK_THROWS_AS(write_png(folder / "no/gray.png", gray.view()), StorageError);
}

TEST_CASE("level ground is as bright as the sine of the light's altitude")
{
    TemporaryFolder folder;
    make_slope(folder / "flat.tif", 0, {5, 6});
    write_hillshade(folder / "flat.tif", folder / "shade.tif");
    // gdaldem: 1 + 254 * sin(45 degrees) = 180.6, rounded
    CHECK(read_band(folder / "shade.tif", 1) == std::vector<double>(30, 181));
    CHECK(folder.names() == std::vector<std::string>{"flat.tif", "shade.tif"});
}

TEST_CASE("a slope that faces the light is brighter than one that turns away")
{
    TemporaryFolder folder;
    HillshadeOptions options;
    options.azimuth_deg = 90; // from the east, where the ground falls to
    make_slope(folder / "slope.tif", 0.5, {5, 6});
    write_hillshade(folder / "slope.tif", folder / "lit.tif", options);
    options.azimuth_deg = 270;
    write_hillshade(folder / "slope.tif", folder / "dark.tif", options);
    CHECK(read_band(folder / "lit.tif", 1)[8] > 220);
    CHECK(read_band(folder / "dark.tif", 1)[8] < 100);
    options.z_factor = 0;
    CHECK_THROWS_WITH(write_hillshade(folder / "slope.tif", folder / "x.tif", options),
                      Contains("z_factor") && Contains("above 0"));
    CHECK_THROWS_AS(write_hillshade(folder / "absent.tif", folder / "x.tif"), InputError);
    CHECK_FALSE(
        write_hillshade(folder / "slope.tif", folder / "x.tif", {}, [] { return false; }));
    CHECK_FALSE(std::filesystem::exists(folder / "x.tif"));
}

TEST_CASE("the top of a raster without georeference is north to the light")
{
    TemporaryFolder folder;
    std::vector<double> heights; // rising downwards: the slope faces the top
    for (int r = 0; r < 6; ++r) {
        heights.insert(heights.end(), 5, 0.5 * r);
    }
    make_raster(folder / "slope.tif", GDT_Float32, {6, 5}, {heights});
    HillshadeOptions options;
    for (const double azimuth_deg : {0.0, 315.0, 45.0, 360.0}) {
        options.azimuth_deg = azimuth_deg;
        write_hillshade(folder / "slope.tif", folder / "lit.tif", options);
        CHECK(read_band(folder / "lit.tif", 1)[12] > 200);
    }
    options.azimuth_deg = 180;
    write_hillshade(folder / "slope.tif", folder / "dark.tif", options);
    CHECK(read_band(folder / "dark.tif", 1)[12] < 100);
}

TEST_CASE("a quick look averages valid pixels only and keeps empty areas black")
{
    TemporaryFolder folder;
    // Two columns of 2 x 2 cells: one without values, one half valid at 40, one at 200.
    make_raster(folder / "x.tif", GDT_Float32, {2, 6},
                {{-1, -1, -1, 40, 200, 200, -1, -1, 40, -1, 200, 200}},
                [](GDALDatasetH d) { GDALSetRasterNoDataValue(GDALGetRasterBand(d, 1), -1); });
    QuicklookOptions options;
    options.max_side_px = 3;
    options.style = QuicklookStyle::hillshade;
    write_quicklook_png(folder / "x.tif", folder / "x.png", options);
    CHECK(RasterSource({folder / "x.png"}).size() == Size{1, 3});
    CHECK(read_band(folder / "x.png", 1) == std::vector<double>{0, 40, 200});
    options.style = QuicklookStyle::gray;
    write_quicklook_png(folder / "x.tif", folder / "x.png", options);
    CHECK(read_band(folder / "x.png", 1) == std::vector<double>{0, 0, 255});
    options.style = QuicklookStyle::disparity;
    write_quicklook_png(folder / "x.tif", folder / "x.png", options);
    for (int band = 1; band <= 3; ++band) {
        const auto at = static_cast<std::size_t>(band - 1);
        CHECK(read_band(folder / "x.png", band) ==
              std::vector<double>{0, double(turbo(0)[at]), double(turbo(1)[at])});
    }
}

TEST_CASE("a quick look of a raster without any value is black, and a small one keeps its size")
{
    TemporaryFolder folder;
    make_raster(folder / "x.tif", GDT_Float32, {2, 2}, {{NAN, NAN, NAN, NAN}});
    write_quicklook_png(folder / "x.tif", folder / "x.png");
    CHECK(read_band(folder / "x.png", 1) == std::vector<double>{0, 0, 0, 0});
    QuicklookOptions options;
    options.max_side_px = 0;
    CHECK_THROWS_AS(write_quicklook_png(folder / "x.tif", folder / "x.png", options),
                    ConfigError);
}

TEST_CASE("the colour map runs from blue over green to red")
{
    const Rgb low = turbo(0.1);
    const Rgb middle = turbo(0.5);
    const Rgb high = turbo(0.95);
    CHECK((low[2] > low[0] && low[2] > low[1]));
    CHECK((middle[1] > middle[0] && middle[1] > middle[2]));
    CHECK((high[0] > high[1] && high[0] > high[2]));
    CHECK(turbo(-3) == turbo(0));
    CHECK(turbo(7) == turbo(1));
}
