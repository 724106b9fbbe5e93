#include "tests/catch.h"

#include "io/error.h"
#include "io/geotiff_writer.h"
#include "pipeline/geometry/map_projection.h"
#include "pipeline/stages/elevation_stage.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

using namespace hsgm;
using namespace hsgm::pipeline;

namespace {

/// A folder with a DEM of 10 x 20 posts of a hundredth of a degree from 15 E, 48 N southwards:
/// 100 m plus a metre for each column; one post has no value.
class Dem {
public:
    explicit Dem(const std::string& crs = "EPSG:4326", const std::string& vertical = "")
        : folder_(std::filesystem::temp_directory_path() /
                  ("hsgm-dem-" + std::to_string(getpid()) + "-" + std::to_string(number_++)))
    {
        std::filesystem::create_directory(folder_);
        io::RasterOptions options;
        options.nodata = -9999;
        options.geo = {std::array{15.0, 0.01, 0.0, 48.0, 0.0, -0.01},
                       geometry::MapProjection::from_text(crs, vertical).wkt()};
        io::GeoTiffWriter writer(path(), {10, 20}, io::PixelType::float32, options);
        tiling::Image<float> heights({10, 20});
        for (int r = 0; r < 10; ++r) {
            for (int c = 0; c < 20; ++c) {
                heights(r, c) = r == 5 && c == 5 ? -9999.0F : static_cast<float>(100 + c);
            }
        }
        writer.write(rect_of(heights.size()), heights);
        writer.finish();
    }
    ~Dem() { std::filesystem::remove_all(folder_); }
    Dem(const Dem&) = delete;
    Dem& operator=(const Dem&) = delete;
    std::string path() const { return (folder_ / "dem.tif").string(); }

private:
    static int number_;
    std::filesystem::path folder_;
};

int Dem::number_ = 0;

const geometry::MapBox kAll{15.0, 47.9, 15.2, 48.0};

} // namespace

TEST_CASE("a DEM's posts are its pixels' centres, and missing ones stay missing")
{
    const Dem dem;
    const Elevation whole = read_elevation({dem.path(), ""}, kAll);
    CHECK(whole.warning.find("does not say what its heights count from") != std::string::npos);
    const geometry::ElevationGrid& grid = *whole.grid;
    const auto at = [&](double longitude, double latitude) {
        return grid.height_m(grid.grid().pixel_of(longitude, latitude));
    };
    CHECK(at(15.005, 47.995) == Approx(100));
    CHECK(at(15.12, 47.95) == Approx(111.5));
    CHECK(std::isnan(at(15.055, 47.945)));
    // Only what lies round the box is read.
    const Elevation part =
        read_elevation({dem.path(), "ellipsoid"}, {15.02, 47.96, 15.03, 47.97});
    CHECK(part.warning.empty());
    CHECK(part.grid->posts().cols() < 12);
    CHECK(part.grid->height_m(part.grid->grid().pixel_of(15.025, 47.965)) == Approx(102));
}

TEST_CASE("heights of a DEM become those above the ellipsoid")
{
    const Dem plain;
    const Dem said("EPSG:4326", "EGM96");
    const auto height = [](const Elevation& elevation) {
        return elevation.grid->height_m(elevation.grid->grid().pixel_of(15.005, 47.995));
    };
    const Elevation by_key = read_elevation({plain.path(), "EGM96"}, kAll);
    const Elevation by_file = read_elevation({said.path(), ""}, kAll);
    CHECK(by_file.warning.empty());
    // At 15 E, 48 N the geoid lies some 45 m above the ellipsoid.
    CHECK(height(by_key) > 143);
    CHECK(height(by_key) < 147);
    CHECK(height(by_file) == Approx(height(by_key)));
    CHECK(height(read_elevation({said.path(), "ellipsoid"}, kAll)) == Approx(100));
}

TEST_CASE("a DEM elsewhere, of no map or of an unknown datum is refused")
{
    const Dem dem;
    CHECK_THROWS_WITH(read_elevation({dem.path(), ""}, {16, 47, 16.5, 47.5}),
                      Catch::Matchers::Contains("has no height where the images lie") &&
                          Catch::Matchers::Contains("it covers 15.0000 to 15.2000"));
    CHECK_THROWS_AS(read_elevation({dem.path(), "EGM2008"}, kAll), io::ConfigError);
    CHECK_THROWS_AS(read_elevation({"nowhere.tif", ""}, kAll), io::InputError);
    CHECK_THROWS_AS(check_vertical("EGM2008"), std::invalid_argument);
    check_vertical("ellipsoid");
    check_vertical("EGM96");
}
