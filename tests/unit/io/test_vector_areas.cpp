// Polygons of vector files: areas, and masks of images.

#include "io/error.h"
#include "io/raster_source.h"
#include "io/vector_areas.h"
#include "tests/unit/io/sample_rasters.h"

#include <ogr_srs_api.h>

using namespace hsgm;
using namespace hsgm::io;
using samples::flat;
using samples::make_raster;
using samples::put_bytes;
using samples::TemporaryFolder;

namespace {

std::string geojson(const std::string& crs, const std::string& polygons)
{
    return R"({"type": "FeatureCollection", "crs": )" + crs + R"(, "features": [)" + polygons +
           "]}";
}

std::string polygon(const std::string& rings)
{
    return R"({"type": "Feature", "properties": {}, "geometry": {"type": "Polygon",
        "coordinates": [)" +
           rings + "]}}";
}

constexpr const char* kUtm =
    R"({"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32633"}})";

std::string words_of(const std::function<void()>& act)
{
    try {
        act();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

std::vector<double> pixels_of(const ImageSpec& spec)
{
    RasterSource source(spec);
    tiling::Image<double> pixels(source.size());
    source.read(rect_of(source.size()), pixels);
    return flat(pixels);
}

} // namespace

TEST_CASE("areas come with all their rings and their reference system")
{
    const TemporaryFolder folder;
    put_bytes(folder / "a.geojson",
              geojson(kUtm, polygon("[[0,0],[9,0],[9,9],[0,9],[0,0]],"
                                    "[[2,2],[4,2],[4,4],[2,4],[2,2]]") +
                                "," + polygon("[[20,0],[30,0],[30,5],[20,0]]")));
    const VectorAreas areas = read_areas(folder / "a.geojson");
    CHECK(areas.rings.size() == 3);
    CHECK(areas.wkt.find("UTM zone 33N") != std::string::npos);
}

TEST_CASE("areas that overlap are one, so that nothing is counted twice")
{
    const TemporaryFolder folder;
    put_bytes(folder / "a.geojson",
              geojson(kUtm, polygon("[[0,0],[4,0],[4,4],[0,4],[0,0]]") + "," +
                                polygon("[[2,0],[8,0],[8,4],[2,4],[2,0]]")));
    const VectorAreas areas = read_areas(folder / "a.geojson");
    REQUIRE(areas.rings.size() == 1);
    double west = 1e9;
    double east = -1e9;
    for (const auto& corner : areas.rings[0]) {
        west = std::min(west, corner[0]);
        east = std::max(east, corner[0]);
    }
    CHECK(west == 0);
    CHECK(east == 8);
}

TEST_CASE("vector files without polygons, or none at all, are refused")
{
    const TemporaryFolder folder;
    put_bytes(folder / "points.geojson",
              geojson(kUtm, R"({"type": "Feature", "properties": {}, "geometry":
                  {"type": "Point", "coordinates": [1, 2]}})"));
    CHECK(words_of([&] {
              read_areas(folder / "points.geojson");
          }).find("points.geojson holds no polygon") != std::string::npos);
    put_bytes(folder / "text.txt", "hello");
    CHECK(words_of([&] { read_areas(folder / "text.txt"); }).find("as a vector file") !=
          std::string::npos);
    CHECK_FALSE(words_of([&] { read_areas(folder / "none.gpkg"); }).empty());
}

TEST_CASE("polygons in pixels take values away where they cover centres of pixels")
{
    const TemporaryFolder folder;
    make_raster(folder / "image.tif", GDT_Byte, {3, 4},
                {{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}});
    // Corners of pixels count: columns 1 and 2 of rows 1 and 2.
    put_bytes(folder / "clouds.csv", "id,WKT\n1,\"POLYGON((1 1,3 1,3 3,1 3,1 1))\"\n");
    const ImageSpec spec{folder / "image.tif", 0, std::nullopt, folder / "clouds.csv"};
    CHECK(pixels_of(spec) == std::vector<double>{1, 2, 3, 4, 5, -1, -1, 8, 9, -1, -1, 12});
    // A window sees the same.
    RasterSource source(spec);
    tiling::Image<double> part({2, 2});
    source.read({1, 2, 2, 2}, part);
    CHECK(flat(part) == std::vector<double>{-1, 8, -1, 12});
    const auto files = source.files();
    CHECK(std::count(files.begin(), files.end(), folder / "clouds.csv") == 1);
}

TEST_CASE("polygons on a map are brought into the image by its map")
{
    const TemporaryFolder folder;
    make_raster(folder / "image.tif", GDT_Byte, {3, 4},
                {{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}}, [](GDALDatasetH dataset) {
                    double transform[] = {500000, 10, 0, 5300000, 0, -10};
                    GDALSetGeoTransform(dataset, transform);
                    OGRSpatialReferenceH crs = OSRNewSpatialReference(nullptr);
                    OSRImportFromEPSG(crs, 32633);
                    GDALSetSpatialRef(dataset, crs);
                    OSRDestroySpatialReference(crs);
                });
    put_bytes(folder / "clouds.geojson",
              geojson(kUtm, polygon("[[500010,5299970],[500030,5299970],[500030,5299990],"
                                    "[500010,5299990],[500010,5299970]]")));
    CHECK(pixels_of({folder / "image.tif", 0, std::nullopt, folder / "clouds.geojson"}) ==
          std::vector<double>{1, 2, 3, 4, 5, -1, -1, 8, 9, -1, -1, 12});
}

TEST_CASE("a vector mask without polygons masks nothing, one that has no way in is refused")
{
    const TemporaryFolder folder;
    make_raster(folder / "image.tif", GDT_Byte, {1, 3}, {{1, 2, 3}});
    put_bytes(folder / "clear.geojson", geojson(kUtm, ""));
    CHECK(pixels_of({folder / "image.tif", 0, std::nullopt, folder / "clear.geojson"}) ==
          std::vector<double>{1, 2, 3});
    put_bytes(folder / "map.geojson", geojson(kUtm, polygon("[[0,0],[9,0],[9,9],[0,0]]")));
    const std::string words = words_of([&] {
        RasterSource({folder / "image.tif", 0, std::nullopt, folder / "map.geojson"});
    });
    CHECK(words.find("map.geojson is in map coordinates, which cannot be brought into") !=
          std::string::npos);
}
