#include "tests/refusals/earlier_result.h"

#include "tests/catch.h"

using namespace hsgm::tests;

namespace {

const std::string kPair = "pair: {left: left.tif, right: right.tif}\n";
const std::string kGeometry = "geometry: {kind: rectified}\n";
const std::string kOutput = "output: {folder: result}\n";
const std::string kMatcher = "matcher: {disparity: [0, 10]}\n";

} // namespace

TEST_CASE("unknown keys are refused with line, column and the nearest known one")
{
    EarlierResult place;
    place.refused_config(
        kPair + kGeometry + kOutput + "matcher:\n  disparity: [0, 10]\n  cots: hmi\n",
        {"bad.yaml:6:3", "unknown key 'matcher.cots'", "did you mean 'cost'?"});
    place.refused_config(kPair + kGeometry + kOutput + kMatcher + "outptu: {}\n",
                         {"bad.yaml:5:1", "'outptu'", "did you mean 'output'?"});
    place.refused_config("pair: {left: {path: left.tif, nodta: 0}, right: right.tif}\n" +
                             kGeometry + kOutput + kMatcher,
                         {"bad.yaml:1:31", "'pair.left.nodta'", "did you mean 'nodata'?"});
    place.refused_config(kPair + kGeometry + kOutput + kMatcher + "banana: 1\n",
                         {"bad.yaml:5:1", "'banana'", "known here: pair, geometry, output"});
}

TEST_CASE("values of the wrong type, unit or size are refused by key")
{
    EarlierResult place;
    const auto refused = [&](const std::string& more, const std::vector<std::string>& words) {
        place.refused_config(pair_config(", " + more), words);
    };
    refused("paths: eight", {"bad.yaml:4:38", "'matcher.paths' is 'eight'", "4, 5, 8, 16"});
    refused("paths: 7", {"'matcher.paths' is '7'", "4, 5, 8, 16"});
    refused("paths: [8]", {"'matcher.paths' is a list", "4, 5, 8, 16"});
    refused("window: 50", {"bad.yaml:4:39", "'matcher.window'", "multiple of 16", "not 50"});
    refused("window: 8", {"'matcher.window' is '8'", "from 16 to 1024"});
    refused("halo: 7", {"'matcher.halo'", "even number from 0 to the window size", "not 7"});
    refused("p1: 300", {"'matcher.p1'", "0..p2", "not 300"});
    refused("p2: 5000", {"'matcher.p2' is '5000'", "from 0 to 4000"});
    refused("median: 4", {"'matcher.median'", "1 (off), 3 or 5", "not 4"});
    refused("levels: 13", {"'matcher.levels' is '13'", "from 1 to 12 or 'auto'"});
    refused("prior: maybe", {"'matcher.prior' is 'maybe'", "true or false"});
    refused("smooth: 4", {"'matcher.smooth'", "1 (off), 3 or 5", "not 4"});
    refused("p2_half_tone: 0", {"'matcher.p2_half_tone' is '0'", "from 1 to 255"});
    refused("profile: city", {"'matcher.profile' is 'city'", "satellite, aerial, close"});
    refused("mode: fast", {"'matcher.mode' is 'fast'", "hsgm, hsgm-paper, sgm, local"});
    place.refused_config(pair_config() + "run: {memory: 8 bananas}\n",
                         {"bad.yaml:5:15", "'run.memory'", "8 bananas", "GiB"});
    place.refused_config(pair_config() + "run: {memory: 120%}\n",
                         {"'run.memory'", "120%", "at most at 100%"});
    place.refused_config(pair_config() + "run: {device: banana}\n",
                         {"bad.yaml:5:15", "'run.device' is 'banana'", "auto, cpu, cuda"});
    place.refused_config(pair_config() + "run: {order: spiral}\n",
                         {"'run.order' is 'spiral'", "rows, columns, reversed, shuffled"});
}

TEST_CASE("disparity ranges of a configuration are refused by key")
{
    EarlierResult place;
    const auto refused = [&](const std::string& range, const std::vector<std::string>& words) {
        place.refused_config(
            kPair + kGeometry + kOutput + "matcher: {disparity: " + range + "}\n", words);
    };
    refused("[10, 0]", {"bad.yaml:4:22", "'matcher.disparity' is [10, 0]", "not above"});
    refused("[0]", {"'matcher.disparity' is a list", "[min, max] in whole numbers"});
    refused("10", {"'matcher.disparity' is '10'", "[min, max] in whole numbers"});
    refused("[0, ten]", {"'matcher.disparity' is [0, ten]", "whole numbers"});
    refused("[5000, 5100]", {"5000..5100", "no left pixel has a counterpart", "-89..89"});
    refused("auto", {"bad.yaml:4:22", "'matcher.disparity' must be given as [min, max]"});
}

TEST_CASE("what a configuration must say is asked for by key")
{
    EarlierResult place;
    place.refused_config("pair: {left: left.tif}\n" + kGeometry + kOutput + kMatcher,
                         {"'pair.right' is missing", "a path"});
    place.refused_config(kGeometry + kOutput + kMatcher, {"'pair.left' is missing", "a path"});
    place.refused_config(kPair + kOutput + kMatcher,
                         {"'geometry.kind' is missing", "rectified"});
    place.refused_config(kPair + kGeometry + kMatcher,
                         {"'output.folder' is missing", "a path"});
    place.refused_config(kPair + kGeometry + kOutput, {"'matcher.disparity' must be given"});
    place.refused_config(
        kPair + kOutput + kMatcher + "geometry: {kind: orbit}\n",
        {"bad.yaml:4:18", "'geometry.kind'", "rectified", "rpc", "ortho", "not 'orbit'"});
    place.refused_config(
        kPair + kOutput + "geometry: {kind: ortho}\n",
        {"bad.yaml:3:18", "'geometry.kind' is ortho", "reference_height_m", "reference_dem"});
    place.refused_config(kPair + kOutput + "geometry: {kind: ortho, refernce_dem: x.tif}\n",
                         {"unknown key 'geometry.refernce_dem'", "'reference_dem'"});
    place.refused_config(kPair + kOutput + kMatcher + "geometry: {kind: rpc}\n",
                         {"bad.yaml:3:22", "'matcher.disparity' is found by the program",
                          "leave it out", "geometry.heights_m"});
}

TEST_CASE("what does not go together is refused by key")
{
    EarlierResult place;
    const auto refused = [&](const std::string& geometry,
                             const std::vector<std::string>& words) {
        place.refused_config(kPair + kOutput + kMatcher + "geometry: {kind: rectified, " +
                                 geometry + "}\n",
                             words);
    };
    refused("reference_height_m: 3",
            {"bad.yaml:4:49", "'geometry.reference_height_m'", "without height_per_px_m"});
    refused("focal_px: 3", {"'geometry.focal_px'", "set both focal_px and baseline_m"});
    refused("baseline_m: 3", {"'geometry.baseline_m'", "set both focal_px and baseline_m"});
    refused("focal_px: 3, baseline_m: 1, height_per_px_m: 1", {"focal_px", "one of them"});
    refused("height_per_px_m: 0", {"'geometry.height_per_px_m' is 0", "leave it out"});
    refused("focal_px: -1, baseline_m: 1", {"'geometry.focal_px' is '-1'", "at least"});
}

TEST_CASE("files that are no configuration are refused")
{
    EarlierResult place;
    place.refused_config(pair_config(", cost: hmi, cost: hmi"),
                         {"bad.yaml:4:42", "'cost' comes twice", "keep one"});
    place.refused_config(kPair + "matcher: {disparity: [0, 10]\n",
                         {"bad.yaml:3:1", "no valid YAML"});
    place.refused_config("", {"bad.yaml", "empty", "map of keys and values"});
    place.refused_config("hello\n", {"bad.yaml:1:1", "'hello'", "map of keys and values"});
    place.refused_config("- 1\n", {"bad.yaml:1:1", "a list", "map of keys and values"});
    place.refused({"run", place / "nowhere.yaml"}, 2,
                  {"no configuration file", "nowhere.yaml"});
    place.refused({"run", place.folder().path().string()}, 2, {"cannot be read as a file"});
    place.refused({"synth", place / "nowhere.yaml", "-o", place / "scene"}, 2,
                  {"no configuration file", "nowhere.yaml"});
}
