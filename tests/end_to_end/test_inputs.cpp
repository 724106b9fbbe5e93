#include "tests/end_to_end/pairs.h"
#include "tests/end_to_end/rasters.h"

#include "matcher/reasons.h"

#include <cmath>
#include <limits>

using namespace hsgm::tests;
using namespace hsgm;
using tiling::Image;
using tiling::Size;

namespace {

constexpr Size kSize{60, 90};

Outcome match(const std::string& left, const std::string& right, const std::string& output,
              const std::string& range = "0,10")
{
    return hsgm_does({"match", left, right, "-o", output, "--disparity=" + range});
}

// Runs left.tif, told more about, against right.tif.
void run_left(const TemporaryFolder& folder, const std::string& left)
{
    put_bytes(folder / "run.yaml", "pair: {left: {path: left.tif, " + left +
                                       "}, right: right.tif}\n"
                                       "geometry: {kind: rectified}\n"
                                       "output: {folder: result}\n"
                                       "matcher: {disparity: [0, 10]}\n");
    hsgm_does({"run", folder / "run.yaml"});
}

bool has(double reasons, matcher::Reason bit)
{
    return (static_cast<unsigned>(reasons) & bit) != 0;
}

} // namespace

TEST_CASE("a pair inside a zip archive is matched like the pair itself")
{
    const TemporaryFolder folder;
    make_pair(folder);
    const std::string zip = "/vsizip/" + (folder / "pair.zip");
    for (const std::string name : {"left.tif", "right.tif"}) {
        put_bytes(zip + "/" + name, io::samples::bytes_of_file(folder / name));
    }
    match(folder / "left.tif", folder / "right.tif", folder / "plain.tif");
    match(zip + "/left.tif", zip + "/right.tif", folder / "zipped.tif");
    const Snapshot files = snapshot(folder.path().string());
    CHECK((files.at("plain.tif") == files.at("zipped.tif")));
}

TEST_CASE("a colour image is matched by its luminance")
{
    const TemporaryFolder folder;
    make_pair(folder);
    const Pixels red = noise(kSize, 1);
    const Pixels green = noise(kSize, 2);
    const Pixels blue = noise(kSize, 3);
    Pixels gray(red.size());
    for (std::size_t i = 0; i < gray.size(); ++i) {
        gray[i] = std::floor((4899 * red[i] + 9617 * green[i] + 1868 * blue[i] + 8192) / 16384);
    }
    make_raster(folder / "gray.tif", GDT_Byte, kSize, {gray});
    make_raster(folder / "colour.tif", GDT_Byte, kSize, {red, green, blue}, {},
                {"PHOTOMETRIC=RGB"});
    match(folder / "gray.tif", folder / "right.tif", folder / "by_gray.tif");
    match(folder / "colour.tif", folder / "right.tif", folder / "by_colour.tif");
    const Snapshot files = snapshot(folder.path().string());
    CHECK((files.at("by_gray.tif") == files.at("by_colour.tif")));
}

TEST_CASE("nodata and a mask of the configuration take pixels out, with a reason")
{
    const TemporaryFolder folder;
    make_pair(folder);
    Pixels mask(static_cast<std::size_t>(kSize.area()), 255);
    for (std::size_t i = 30; i < 40; ++i) {
        mask[1800 + i] = 0; // in row 20
    }
    make_raster(folder / "mask.tif", GDT_Byte, kSize, {mask});
    run_left(folder, "mask: mask.tif, nodata: 77");
    const Image<double> left = pixels_of(folder / "left.tif");
    const Image<double> reasons = pixels_of(folder / "result/reasons.tif");
    const Image<double> d = pixels_of(folder / "result/disparity.tif");
    int marked = 0;
    int wrong = 0;
    for (std::size_t i = 0; i < mask.size(); ++i) {
        const bool absent = mask[i] == 0 || left.pixels()[i] == 77;
        const bool bit = has(reasons.pixels()[i], matcher::kNodataLeft);
        marked += bit;
        wrong += bit != absent || (absent && !std::isnan(d.pixels()[i]));
    }
    CHECK(marked >= 10);
    CHECK(wrong == 0);
}

TEST_CASE("NaN, infinity and nodata are data that get a reason")
{
    const TemporaryFolder folder;
    make_pair(folder);
    Pixels left = noise(kSize);
    left[10 * 90 + 20] = std::numeric_limits<double>::quiet_NaN();
    left[11 * 90 + 30] = std::numeric_limits<double>::infinity();
    left[12 * 90 + 40] = -std::numeric_limits<double>::infinity();
    left[13 * 90 + 50] = -9999;
    make_raster(folder / "left.tif", GDT_Float32, kSize, {left}, [](GDALDatasetH dataset) {
        GDALSetRasterNoDataValue(GDALGetRasterBand(dataset, 1), -9999);
    });
    match(folder / "left.tif", folder / "right.tif", folder / "d.tif");
    const Image<double> reasons = pixels_of(folder / "d.reasons.tif");
    int marked = 0;
    for (const double pixel : reasons.pixels()) {
        marked += has(pixel, matcher::kNodataLeft);
    }
    CHECK(marked == 4);
    for (const int at : {10, 11, 12, 13}) {
        CHECK(has(reasons.view()(at, at * 10 - 80), matcher::kNodataLeft));
    }
}

TEST_CASE("images of one pixel are matched")
{
    const TemporaryFolder folder;
    make_raster(folder / "one.tif", GDT_Byte, {1, 1}, {{7}});
    for (const std::string range : {"0,0", "0,63", "-64,64"}) {
        match(folder / "one.tif", folder / "one.tif", folder / "d.tif", range);
        CHECK(pixels_of(folder / "d.tif").size() == Size{1, 1});
    }
}

TEST_CASE("one disparity is a range")
{
    const TemporaryFolder folder;
    make_pair(folder);
    match(folder / "left.tif", folder / "right.tif", folder / "d.tif", "5,5");
    const Image<double> d = pixels_of(folder / "d.tif");
    int values = 0;
    for (const double pixel : d.pixels()) {
        values += !std::isnan(pixel);
        CHECK((std::isnan(pixel) || pixel == 5));
    }
    CHECK(values == 60 * 85);
}

TEST_CASE("the right image may be of another width")
{
    const TemporaryFolder folder;
    make_pair(folder, {60, 130});
    const Pixels wide = shifted(noise({60, 130}), {60, 130}, 5);
    Pixels narrow;
    for (std::size_t i = 0; i < wide.size(); ++i) {
        if (i % 130 < 90) {
            narrow.push_back(wide[i]);
        }
    }
    make_raster(folder / "narrow.tif", GDT_Byte, {60, 90}, {narrow});
    match(folder / "left.tif", folder / "narrow.tif", folder / "d.tif");
    const Image<double> d = pixels_of(folder / "d.tif");
    const Image<double> reasons = pixels_of(folder / "d.reasons.tif");
    CHECK(d.size() == Size{60, 130});
    CHECK(d.view()(30, 50) == Approx(5).margin(0.1));
    CHECK(std::isnan(d.view()(30, 120)));
    CHECK(has(reasons.view()(30, 120), matcher::kOutside));
    match(folder / "narrow.tif", folder / "right.tif", folder / "wide.tif", "-10,10");
    CHECK(pixels_of(folder / "wide.tif").size() == Size{60, 90});
}
