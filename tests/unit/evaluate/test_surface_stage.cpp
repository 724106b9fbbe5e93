#include "tests/catch.h"

#include "io/error.h"
#include "io/geotiff_writer.h"
#include "io/raster_source.h"
#include "pipeline/stages/surface_stage.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>

using namespace hsgm;
using namespace hsgm::pipeline;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct TemporaryFolder {
    std::string path = (std::filesystem::temp_directory_path() /
                        ("hsgm_surface_" + std::to_string(::getpid())))
                           .string();
    TemporaryFolder() { std::filesystem::create_directories(path); }
    ~TemporaryFolder() { std::filesystem::remove_all(path); }
    std::string operator/(const std::string& name) const { return path + "/" + name; }
};

// A hilly ground of heights around 100 m, at map coordinates.
double ground(double x, double y)
{
    return 100 + 6 * std::sin(0.11 * x) * std::cos(0.07 * y) + 3 * std::sin(0.05 * (x + 2 * y));
}

struct Grid {
    double left = 500'000;
    double top = 4'000'000;
    double cell = 0.5;
    tiling::Size size{240, 300};
};

using Height = std::function<double(double x, double y)>;

template <typename T>
void write(const std::string& path, const Grid& grid, const std::string& crs,
           const Height& height)
{
    io::RasterOptions options;
    options.geo.transform = {grid.left, grid.cell, 0, grid.top, 0, -grid.cell};
    options.geo.wkt = crs;
    io::GeoTiffWriter writer(path, grid.size, io::pixel_type_of<T>(), options);
    tiling::Image<T> image(grid.size);
    for (int row = 0; row < grid.size.rows; ++row) {
        for (int col = 0; col < grid.size.cols; ++col) {
            image(row, col) = static_cast<T>(height(grid.left + (col + 0.5) * grid.cell,
                                                    grid.top - (row + 0.5) * grid.cell));
        }
    }
    writer.write(rect_of(grid.size), image);
    writer.finish();
}

const std::string kUtm = "EPSG:32633";

struct Scene {
    TemporaryFolder folder;
    SurfaceQuestion question;

    // The test lies 1.25 m east, 0.5 m south and 2 m up, on a grid of its own.
    Scene()
    {
        write<float>(folder / "reference.tif", {}, kUtm, ground);
        Grid other;
        other.left -= 7.3;
        other.top += 4.1;
        other.cell = 0.4;
        other.size = {330, 400};
        write<float>(folder / "test.tif", other, kUtm,
                     [](double x, double y) { return ground(x - 1.25, y + 0.5) + 2; });
        question.inputs.test = folder / "test.tif";
        question.inputs.reference = folder / "reference.tif";
    }
};

} // namespace

TEST_CASE("a shifted surface on another grid is brought back")
{
    Scene scene;
    scene.question.difference = scene.folder / "difference.tif";
    const SurfaceAnswer answer = score_surface(scene.question);
    CHECK(answer.horizontal);
    CHECK(answer.shift.east == Approx(1.25).margin(0.01));
    CHECK(answer.shift.north == Approx(-0.5).margin(0.01));
    CHECK(answer.shift.up == Approx(2).margin(0.005));
    CHECK(answer.all.evaluated == 240 * 300);
    CHECK(answer.all.within[0].percent > 97); // the test ends before the reference does
    CHECK(answer.all.rmse_m < 0.02);

    io::RasterSource difference(io::ImageSpec{scene.question.difference});
    CHECK(difference.size() == tiling::Size{240, 300});
    tiling::Image<double> values({1, 1});
    difference.read({100, 100, 1, 1}, values);
    CHECK(std::abs(values(0, 0)) < 0.05);
}

TEST_CASE("relief that goes one way only shows no shift, and the fit does not run away")
{
    const TemporaryFolder folder;
    // Ridges from north to south, nearly level along them; an error of 3 cm that goes with what
    // little slope there is along them, as a slight tilt of a camera makes it.
    const auto along = [](double y) { return 0.02 * std::sin(0.09 * y); };
    write<float>(folder / "ridges.tif", {}, kUtm,
                 [&](double x, double y) { return 100 + 6 * std::sin(0.11 * x) + along(y); });
    write<float>(folder / "test.tif", {}, kUtm, [&](double x, double y) {
        return 102 + 6 * std::sin(0.11 * (x - 0.5)) + along(y) + 0.03 * std::cos(0.09 * y);
    });
    SurfaceQuestion question;
    question.inputs.reference = folder / "ridges.tif";
    question.inputs.test = folder / "test.tif";
    const SurfaceAnswer answer = score_surface(question);
    CHECK_FALSE(answer.horizontal);
    CHECK(answer.weakest_slope > 0);
    CHECK(answer.weakest_slope < 0.002);
    CHECK(answer.shift.north == 0);
    CHECK(answer.shift.up == Approx(2).margin(0.1));
    // With some relief along the ridges the shift is found.
    const auto hills = [](double y) { return 1.5 * std::sin(0.09 * y); };
    write<float>(folder / "ridges.tif", {}, kUtm,
                 [&](double x, double y) { return 100 + 6 * std::sin(0.11 * x) + hills(y); });
    write<float>(folder / "test.tif", {}, kUtm, [&](double x, double y) {
        return 102 + 6 * std::sin(0.11 * (x - 0.5)) + hills(y);
    });
    const SurfaceAnswer found = score_surface(question);
    CHECK(found.horizontal);
    CHECK(found.weakest_slope > 0.05);
    CHECK(found.shift.east == Approx(0.5).margin(0.02));
    CHECK(found.shift.north == Approx(0).margin(0.02));
}

TEST_CASE("what is taken out is what was asked for")
{
    Scene scene;
    scene.question.alignment = Alignment::none;
    const SurfaceAnswer raw = score_surface(scene.question);
    CHECK(raw.shift == evaluate::SurfaceShift{});
    CHECK(raw.all.mean_error_m == Approx(2).margin(0.1));
    scene.question.alignment = Alignment::up;
    const SurfaceAnswer up = score_surface(scene.question);
    CHECK(up.shift.east == 0);
    CHECK(up.shift.up == Approx(2).margin(0.1));
    CHECK_FALSE(up.horizontal);
    CHECK(up.all.rmse_m > 0.1);
}

TEST_CASE("classes and masks choose what counts, and what the shift is found on")
{
    Scene scene;
    const Height west = [](double x, double) { return x < 500'075 ? 1 : 4; };
    write<std::uint8_t>(scene.folder / "classes.tif", {}, kUtm, west);
    write<std::uint8_t>(scene.folder / "mask.tif", {}, kUtm,
                        [](double, double y) { return y > 3'999'940 ? 7 : 5; });
    // Half of the test is wrong by 50 m, from 3 m beyond the border on.
    write<float>(scene.folder / "test.tif", {}, kUtm, [](double x, double y) {
        return x < 500'078 ? ground(x - 0.75, y) + 1 : x < 500'140 ? ground(x, y) + 50 : kNaN;
    });
    scene.question.inputs.classes = scene.folder / "classes.tif";
    scene.question.aligned_on = {1};
    const SurfaceAnswer answer = score_surface(scene.question);
    CHECK(answer.shift.east == Approx(0.75).margin(0.01));
    REQUIRE(answer.classes.size() == 2);
    CHECK(answer.classes[0].first == 1);
    CHECK(answer.classes[0].second.rmse_m < 0.1);
    CHECK(answer.classes[1].second.median_error_m == Approx(49).margin(0.5));
    CHECK(answer.classes[1].second.completeness_percent < 90);

    scene.question.inputs.excluded_classes = {4};
    CHECK(score_surface(scene.question).all.evaluated == 150 * 240);
    scene.question.inputs.mask = scene.folder / "mask.tif";
    scene.question.inputs.mask_bits = 2;
    CHECK(score_surface(scene.question).all.evaluated == 150 * 120);
    scene.question.inputs.mask_bits = 1;
    CHECK(score_surface(scene.question).all.evaluated == 150 * 240);
}

TEST_CASE("surfaces that cannot be compared are refused in words")
{
    Scene scene;
    const auto refusal = [&] {
        try {
            score_surface(scene.question);
        } catch (const std::exception& e) {
            return std::string(e.what());
        }
        return std::string("accepted");
    };
    using Catch::Matchers::Contains;
    write<float>(scene.folder / "test.tif", {}, "EPSG:32634", ground);
    CHECK_THAT(refusal(), Contains("UTM zone 34N") && Contains("gdalwarp"));
    write<float>(scene.folder / "test.tif", {}, "", ground);
    CHECK_THAT(refusal(), Contains("no coordinate reference system"));
    Grid far;
    far.left += 10'000;
    write<float>(scene.folder / "test.tif", far, kUtm, ground);
    CHECK_THAT(refusal(), Contains("check that they overlap"));
    scene.question.aligned_on = {1};
    CHECK(refusal() == "--align-classes needs --classes");
    scene.question.aligned_on.clear();
    scene.question.inputs.mask_bits = 3;
    CHECK(refusal() == "--mask-bits needs --mask");
    scene.question.inputs.mask_bits = 0;
    Grid small;
    small.size = {3, 3};
    write<std::uint8_t>(scene.folder / "mask.tif", small, kUtm,
                        [](double, double) { return 1; });
    scene.question.inputs.mask = scene.folder / "mask.tif";
    CHECK_THAT(refusal(), Contains("has 3 rows x 3 columns") && Contains("240 rows"));
    Grid degrees;
    degrees.left = 14;
    degrees.top = 50;
    degrees.cell = 0.001;
    for (const char* name : {"test.tif", "reference.tif"}) {
        write<float>(scene.folder / name, degrees, "EPSG:4326", ground);
    }
    scene.question.inputs.mask.clear();
    CHECK_THAT(refusal(), Contains("is in degrees"));
}
