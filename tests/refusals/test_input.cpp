#include "tests/refusals/earlier_result.h"

#include "tests/catch.h"

#include <limits>

using namespace hsgm::tests;

namespace {

constexpr std::size_t kPixels = 5400; // of 60 x 90
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void declare_nodata(GDALDatasetH dataset)
{
    GDALSetRasterNoDataValue(GDALGetRasterBand(dataset, 1), 0);
}

} // namespace

TEST_CASE("what is no raster is refused as input")
{
    EarlierResult place;
    for (const auto& [name, words] : std::vector<std::pair<std::string, std::string>>{
             {"nowhere.tif", "There is no file "},
             {".", "Cannot open "},
             {"d.tif/x.tif", "There is no file "},
         }) {
        place.refused_pair(name, "right.tif", 3, {words, name});
        place.refused_pair("left.tif", name, 3, {words, name});
    }
    put_bytes(place / "text.tif", "this is no picture\n");
    put_bytes(place / "empty.tif", "");
    make_raster(place / "complex.tif", GDT_CFloat32, {60, 90}, {noise({60, 90})});
    place.remember();
    place.refused_pair("text.tif", "right.tif", 3, {"text.tif", "not recognized"});
    place.refused_pair("empty.tif", "right.tif", 3, {"Cannot open", "empty.tif"});
    place.refused_pair("left.tif", "complex.tif", 3,
                       {"complex.tif, band 1", "CFloat32", "can be read"});
}

TEST_CASE("a TIFF that is cut short is refused in mid-run, whichever image it is")
{
    EarlierResult place;
    make_raster(place / "whole.tif", GDT_Byte, {400, 400}, {noise({400, 400})}, {},
                {"TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64", "COMPRESS=DEFLATE"});
    const std::string bytes = hsgm::io::samples::bytes_of_file(place / "whole.tif");
    put_bytes(place / "cut.tif", bytes.substr(0, bytes.size() / 2));
    put_bytes(place / "header.tif", bytes.substr(0, 100));
    place.remember();
    const std::vector<std::string> cut{"Cannot read rows 0-255, columns 0-399", "cut.tif",
                                       "GDAL says"};
    place.refused_pair("whole.tif", "cut.tif", 3, cut);
    place.refused_pair("cut.tif", "whole.tif", 3, cut);
    place.refused_pair("header.tif", "whole.tif", 3, {"header.tif"});
}

TEST_CASE("images that make no pair are refused")
{
    EarlierResult place;
    make_raster(place / "tall.tif", GDT_Byte, {61, 90}, {noise({61, 90})});
    make_raster(place / "none.tif", GDT_Byte, {60, 90}, {Pixels(kPixels, 0)}, declare_nodata);
    make_raster(place / "nan.tif", GDT_Float32, {60, 90}, {Pixels(kPixels, kNan)});
    place.remember();
    place.refused_pair("left.tif", "tall.tif", 3,
                       {"equal heights", "left.tif", "60", "tall.tif", "61", "resample"});
    for (const std::string name : {"none.tif", "nan.tif"}) {
        place.refused_pair(name, "right.tif", 3, {name, "no valid pixel", "check the nodata"});
        place.refused_pair("left.tif", name, 3, {name, "no valid pixel", "check the nodata"});
    }
}

TEST_CASE("bands and masks that are not there are refused")
{
    EarlierResult place;
    make_raster(place / "tall.tif", GDT_Byte, {61, 90}, {noise({61, 90})});
    make_raster(place / "zero.tif", GDT_Byte, {60, 90}, {Pixels(kPixels, 0)});
    const auto refused_left = [&](const std::string& left,
                                  const std::vector<std::string>& says) {
        put_bytes(place / "bad.yaml", "pair: {left: {path: left.tif, " + left +
                                          "}, right: right.tif}\n"
                                          "geometry: {kind: rectified}\n"
                                          "output: {folder: result}\n"
                                          "matcher: {disparity: [0, 10]}\n");
        place.remember();
        place.refused({"run", place / "bad.yaml"}, 3, says);
    };
    refused_left("band: 4", {"left.tif has 1 band", "no band 4", "count from 1"});
    refused_left("mask: nowhere.tif", {"There is no file", "nowhere.tif"});
    refused_left("mask: tall.tif", {"The mask", "tall.tif has 61 rows", "must agree"});
    refused_left("mask: zero.tif", {"left.tif", "no valid pixel", "the mask"});
}

TEST_CASE("an evaluation of nothing is refused")
{
    EarlierResult place;
    make_raster(place / "none.tif", GDT_Byte, {60, 90}, {Pixels(kPixels, 0)});
    make_raster(place / "tall.tif", GDT_Float32, {61, 90}, {noise({61, 90})});
    make_raster(place / "d.tif", GDT_Float32, {60, 90}, {noise({60, 90})});
    place.remember();
    place.refused({"evaluate", "disparity", place / "d.tif", place / "none.tif"}, 3,
                  {"no pixel of", "none.tif", "check its nodata value"});
    place.refused({"evaluate", "disparity", place / "d.tif", place / "tall.tif"}, 3,
                  {"tall.tif", "61 rows", "60 rows"});
    place.refused({"evaluate", "seams", place / "nowhere.tif"}, 3, {"There is no file"});
}
