#include "tests/refusals/earlier_result.h"

#include "tests/catch.h"

#include <filesystem>

using namespace hsgm::tests;

TEST_CASE("outputs that would replace an input are refused")
{
    EarlierResult place;
    const std::string left = place / "left.tif";
    const std::string right = place / "right.tif";
    const auto refused = [&](const std::string& output, const std::string& named) {
        place.refused({"match", left, right, "-o", output, "--disparity", "0,10"}, 2,
                      {"The output " + named, "is also an input", "name another"});
    };
    refused(left, left);
    refused(right, right);
    // Another name of the same file.
    refused(place / "result/../left.tif", place / "result/../left.tif");
    std::filesystem::create_hard_link(left, place / "x.reasons.tif");
    place.remember();
    refused(place / "x.tif", place / "x.reasons.tif");
    make_raster(place / "result/reasons.tif", GDT_Byte, {60, 90}, {noise({60, 90})});
    put_bytes(place / "bad.yaml", "pair: {left: {path: left.tif, mask: result/reasons.tif}, "
                                  "right: right.tif}\n"
                                  "geometry: {kind: rectified}\noutput: {folder: result}\n"
                                  "matcher: {disparity: [0, 10]}\n");
    place.remember();
    place.refused({"run", place / "bad.yaml"}, 2, {"reasons.tif is also an input"});
}

TEST_CASE("places that take no output are refused before the first pixel")
{
    EarlierResult place;
    const auto refused = [&](const std::string& output, const std::vector<std::string>& words) {
        const std::string sentence =
            place.refused({"match", place / "left.tif", place / "right.tif", "-o",
                           place / output, "--disparity", "0,10"},
                          6, words);
    };
    refused("result", {"Cannot write", "result: it is a folder"});
    refused("nowhere/d.tif", {"nowhere", "No such file or directory", "writable"});
    refused("left.tif/d.tif", {"left.tif", "Not a directory", "writable"});
    put_bytes(place / "bad.yaml", "pair: {left: left.tif, right: right.tif}\n"
                                  "geometry: {kind: rectified}\noutput: {folder: left.tif}\n"
                                  "matcher: {disparity: [0, 10]}\n");
    place.remember();
    place.refused({"run", place / "bad.yaml"}, 6,
                  {"cannot make the output folder", "left.tif"});
    place.refused({"run", place / "run.yaml", "-o", place / "left.tif/x"}, 6,
                  {"cannot make the output folder", "left.tif/x"});
}

TEST_CASE("creation options that GDAL refuses are refused before the first pixel")
{
    EarlierResult place;
    const auto refused = [&](const std::string& option, const std::vector<std::string>& words) {
        const Outcome outcome = run_hsgm(
            {"plan", place / "run.yaml", "--set", "output.creation_options=[" + option + "]"});
        CHECK(outcome.code == 2);
        place.refused(
            {"run", place / "run.yaml", "--set", "output.creation_options=[" + option + "]"}, 2,
            words);
    };
    refused("COMPRESS=BANANA", {"creation option", "disparity.tif", "'BANANA'"});
    refused("COMPRES=LZW", {"creation option", "COMPRES"});
    refused("LZW", {"creation option 'LZW'", "KEY=VALUE"});
}
