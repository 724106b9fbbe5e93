#include "tests/end_to_end/pairs.h"
#include "tests/end_to_end/rasters.h"

#include <cmath>

using namespace hsgm::tests;
using hsgm::tiling::Image;
using nlohmann::json;

namespace {

// A pair whose left image lies in UTM zone 31 north.
void make_located_pair(const TemporaryFolder& folder)
{
    const hsgm::tiling::Size size{60, 90};
    make_pair(folder, size);
    make_raster(folder / "left.tif", GDT_Byte, size, {noise(size)}, [](GDALDatasetH dataset) {
        double transform[6] = {500000, 0.5, 0, 4500000, 0, -0.5};
        GDALSetGeoTransform(dataset, transform);
        GDALSetProjection(dataset, "EPSG:32631");
    });
}

void run_with(const TemporaryFolder& folder, const std::string& geometry)
{
    put_bytes(folder / "run.yaml", "pair: {left: left.tif, right: right.tif}\n"
                                   "geometry: {kind: rectified" +
                                       geometry +
                                       "}\noutput: {folder: result}\n"
                                       "matcher: {disparity: [-3, 10]}\n");
    hsgm_does({"run", folder / "run.yaml"});
}

} // namespace

TEST_CASE("other programs read the rasters with their nodata, georeference and names")
{
    const TemporaryFolder folder;
    make_located_pair(folder);
    run_with(folder, ", height_per_px_m: 0.5, reference_height_m: 100");
    struct Expected {
        std::string name;
        std::string type;
        bool has_nodata;
    };
    for (const Expected& e : {Expected{"disparity", "Float32", true},
                              {"height", "Float32", true},
                              {"confidence", "Byte", false},
                              {"reasons", "UInt16", false},
                              {"hillshade", "Byte", true}}) {
        INFO(e.name);
        const json info = gdalinfo(folder / ("result/" + e.name + ".tif"));
        const json& band = info["bands"][0];
        CHECK(info["size"] == json{90, 60});
        CHECK(band["type"] == e.type);
        CHECK(band["block"] == json{256, 256});
        CHECK(info["metadata"]["IMAGE_STRUCTURE"].contains("COMPRESSION"));
        CHECK(info["geoTransform"] == json{500000.0, 0.5, 0.0, 4500000.0, 0.0, -0.5});
        CHECK_THAT(info["coordinateSystem"]["wkt"].get<std::string>(),
                   Catch::Matchers::Contains("32631"));
        CHECK(band.contains("noDataValue") == e.has_nodata);
        if (e.type == "Float32") {
            CHECK(band["noDataValue"] == -32768.0);
        }
    }
    const json named = gdalinfo(folder / "result/reasons.tif")["metadata"][""];
    CHECK(named["REASON_0001"] == "outside");
    CHECK(named["REASON_0002"] == "nodata_left");
    CHECK(named["REASON_0008"] == "occluded");
    CHECK(named["HSGM_DISPARITY"] == "-3..10 px");
    const Outcome translated =
        run_program({"gdal_translate", "-of", "PNG", "-ot", "Byte", "-scale", "-3", "10",
                     folder / "result/disparity.tif", folder / "d.png"});
    CHECK(translated.code == 0);
}

TEST_CASE("a height is the reference and so much for each pixel of disparity")
{
    const TemporaryFolder folder;
    make_pair(folder);
    run_with(folder, ", height_per_px_m: -0.25, reference_height_m: 100");
    const Image<double> d = pixels_of(folder / "result/disparity.tif");
    const Image<double> height = pixels_of(folder / "result/height.tif");
    REQUIRE(height.size() == d.size());
    int values = 0;
    int wrong = 0;
    for (std::size_t i = 0; i < d.pixels().size(); ++i) {
        const double expected = static_cast<float>(100 - 0.25 * d.pixels()[i]);
        const double found = height.pixels()[i];
        values += !std::isnan(found);
        wrong += std::isnan(expected) ? !std::isnan(found) : found != expected;
    }
    CHECK(values > 4000);
    CHECK(wrong == 0);
}

TEST_CASE("a depth is focal length and baseline over disparity, where that is positive")
{
    const TemporaryFolder folder;
    make_pair(folder);
    run_with(folder, ", focal_px: 1000, baseline_m: 0.2");
    CHECK_FALSE(std::filesystem::exists(folder / "result/height.tif"));
    const Image<double> d = pixels_of(folder / "result/disparity.tif");
    const Image<double> depth = pixels_of(folder / "result/depth.tif");
    int values = 0;
    int without = 0;
    int wrong = 0;
    for (std::size_t i = 0; i < d.pixels().size(); ++i) {
        const double disparity = d.pixels()[i];
        const double found = depth.pixels()[i];
        if (disparity > 0) {
            ++values;
            wrong += std::abs(found - 200 / disparity) > 1e-4 * found;
        } else {
            ++without; // NaN included
            wrong += !std::isnan(found);
        }
    }
    CHECK(values > 4000);
    CHECK(without > 10);
    CHECK(wrong == 0);
}

TEST_CASE("match names its rasters after the one that is asked for")
{
    const TemporaryFolder folder;
    make_pair(folder);
    std::filesystem::create_directory(folder / "out");
    hsgm_does({"match", folder / "left.tif", folder / "right.tif", "-o",
               folder / "out/city.west.tif", "--disparity", "0,10"});
    CHECK(names_in(snapshot(folder / "out")) ==
          std::vector<std::string>{"city.west.confidence.tif", "city.west.reasons.tif",
                                   "city.west.tif"});
}
