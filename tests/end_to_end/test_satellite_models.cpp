// Where the models of raw images come from: files beside them, parts of scenes, other images.

#include "tests/end_to_end/raw_place.h"

#include <cctype>

using namespace hsgm::tests;
using hsgm::io::samples::bytes_of_file;
using hsgm::tiling::Size;

namespace {

constexpr int kFirstRow = 2000; // of the scene that the left image is a part of
constexpr int kFirstCol = 3000;

/// The pixels of an image without its model, as a part of a scene says where it lies.
void write_part(const std::string& image, const std::string& part)
{
    const auto pixels = pixels_of(image);
    make_raster(part, GDT_UInt16, pixels.size(),
                {{pixels.pixels().begin(), pixels.pixels().end()}}, [](GDALDatasetH dataset) {
                    double geo[] = {kFirstCol, 1, 0, kFirstRow, 0, 1};
                    GDALSetGeoTransform(dataset, geo);
                });
}

/// The model of the whole scene, as OSSIM writes it.
std::string geom_of(const std::string& image)
{
    const json rpc = gdalinfo(image)["metadata"]["RPC"];
    std::string text = "type:  ossimRpcModel\npolynomial_format:  B\n";
    for (const auto& [key, value] : rpc.items()) {
        std::string name = key;
        std::transform(name.begin(), name.end(), name.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        std::istringstream numbers(value.get<std::string>());
        if (key.ends_with("_COEFF")) {
            for (int i = 0; i < 20; ++i) {
                std::string number;
                numbers >> number;
                text +=
                    name + (i < 10 ? "_0" : "_") + std::to_string(i) + ":  " + number + "\n";
            }
        } else {
            const double offset = key == "LINE_OFF"   ? kFirstRow
                                  : key == "SAMP_OFF" ? kFirstCol
                                                      : 0;
            std::ostringstream sum;
            sum.precision(17);
            sum << std::stod(value.get<std::string>()) + offset;
            text += name + ":  " + sum.str() + "\n";
        }
    }
    return text;
}

int cells_with(const std::string& reasons, int code)
{
    const auto pixels = pixels_of(reasons);
    return static_cast<int>(std::count(pixels.pixels().begin(), pixels.pixels().end(), code));
}

} // namespace

TEST_CASE("a geom file beside a part of a scene is found, for masks on the map as well")
{
    const RawPlace place;
    write_part(place / "scene/left.tif", place / "part.tif");
    says(place.run("r", {"--set", "pair.left=" + place / "part.tif"}), 3, "has no RPC");
    put_bytes(place / "part.geom", geom_of(place / "scene/left.tif"));
    // x 500060 to 500110, y 5299880 to 5299940 of the map.
    put_bytes(
        place / "clouds.geojson",
        R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {},
                  "geometry": {"type": "Polygon", "coordinates": [[[15.000802, 47.852262],
                  [15.001470, 47.852262], [15.001470, 47.852802], [15.000802, 47.852802],
                  [15.000802, 47.852262]]]}}]})");
    const auto masked = [&](const std::string& image) {
        return "pair.left={path: " + place / image + ", mask: " + place / "clouds.geojson" +
               "}";
    };
    const Outcome outcome = place.run("part", {"--set", masked("part.tif")});
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    REQUIRE(place.run("whole", {"--set", masked("scene/left.tif")}).code == 0);
    // Last digits of offsets may differ, the surface does not.
    const json part = place.score("part");
    const json whole = place.score("whole");
    for (const char* figure : {"rmse_m", "completeness_percent"}) {
        CAPTURE(figure);
        CHECK(std::abs(part[figure].get<double>() - whole[figure].get<double>()) < 0.02);
    }
    constexpr int kMaskedLeft = 3;
    const int cells = cells_with(place / "part/dsm.reasons.tif", kMaskedLeft);
    CHECK(cells > 9000);
    CHECK(std::abs(cells - cells_with(place / "whole/dsm.reasons.tif", kMaskedLeft)) < 50);
}

TEST_CASE("the model of another image is taken where that is named")
{
    const RawPlace place;
    write_part(place / "scene/left.tif", place / "bare.tif");
    REQUIRE(place
                .run("named", {"--set", "pair.left={path: " + place / "bare.tif" +
                                            ", rpc: " + place / "scene/left.tif" + "}"})
                .code == 0);
    REQUIRE(place.run("own").code == 0);
    CHECK(bytes_of_file(place / "named/dsm.tif") == bytes_of_file(place / "own/dsm.tif"));
    says(place.run("r", {"--set", "pair.left={path: " + place / "bare.tif" +
                                      ", rpc: " + place / "scene/truth_dsm.tif" + "}"}),
         3, "is named for its RPC, but GDAL finds none");
    says(place.run("r", {"--set", "pair.left={path: " + place / "bare.tif" +
                                      ", rpc: " + place / "none.tif" + "}"}),
         3, "none.tif");
}
