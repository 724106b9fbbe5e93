#include "tests/refusals/earlier_result.h"

#include "tests/catch.h"

using namespace hsgm::tests;

TEST_CASE("a command line that names no command is refused with the commands there are")
{
    const EarlierResult place;
    place.refused({}, 2, {"a command is missing", "match, run, plan", "hsgm --help"});
    place.refused({"mtach"}, 2, {"no command 'mtach'", "did you mean 'match'?"});
    place.refused({"fly"}, 2, {"no command 'fly'", "there are match, run, plan"});
    place.refused({"evaluate"}, 2, {"a command is missing", "disparity, seams"});
    place.refused({"evaluate", "dsim"}, 2, {"hsgm evaluate", "no command 'dsim'"});
}

TEST_CASE("missing and unknown options are refused with the help to read")
{
    const EarlierResult place;
    const std::string left = place / "left.tif";
    const std::string right = place / "right.tif";
    const std::string d = place / "d.tif";
    place.refused({"match", left}, 2, {"RIGHT is required", "hsgm match --help"});
    place.refused({"match", left, right, "-o", d}, 2, {"--disparity is required"});
    place.refused({"match", left, right, "--disparity", "0,10"}, 2, {"--output is required"});
    place.refused({"match", left, right, "-o", d, "--disparity", "0,10", "--fast"}, 2,
                  {"not expected: --fast", "hsgm match --help"});
    place.refused({"run"}, 2, {"CONFIG is required", "hsgm run --help"});
    place.refused({"synth", place / "run.yaml"}, 2, {"--output is required"});
    place.refused({"--log-level", "loud", "info"}, 2, {"--log-level", "loud"});
    place.refused({"evaluate", "seams", d, "--window", "1"}, 2, {"--window", "2 to"});
}

TEST_CASE("disparity ranges that cannot be searched are refused")
{
    const EarlierResult place;
    const auto refused = [&](const std::string& range, const std::vector<std::string>& words) {
        place.refused_pair("left.tif", "right.tif", 2, words, {"--disparity=" + range});
    };
    refused("10,0", {"--disparity 10,0 is reversed", "smaller number first"});
    refused("10", {"must be MIN,MAX in whole pixels", "'10'"});
    refused("1.5,3", {"must be MIN,MAX in whole pixels", "'1.5,3'"});
    refused("a,b", {"must be MIN,MAX in whole pixels", "'a,b'"});
    refused("0,10,20", {"must be MIN,MAX in whole pixels"});
    refused("90,95", {"90..95", "no left pixel has a counterpart", "-89..89"});
    refused("-5100,-5000", {"-5100..-5000", "no left pixel has a counterpart", "-89..89"});
    refused("0,100000", {"0..100000", "must lie within -16000..16000"});
}

TEST_CASE("overrides are refused by key as the file's own keys are")
{
    const EarlierResult place;
    const auto refused = [&](const std::string& set, const std::vector<std::string>& words) {
        place.refused_pair("left.tif", "right.tif", 2, words, {"--set", set});
    };
    refused("matcher.cots=hmi", {"--set matcher.cots", "did you mean 'cost'?"});
    refused("matcher.cost=hm", {"'matcher.cost' is 'hm'", "census5x5, census7x7"});
    refused("foo=1", {"unknown key 'foo'", "matcher, run"});
    refused("novalue", {"--set novalue", "KEY=VALUE"});
    refused("=3", {"KEY=VALUE"});
    refused("matcher=1", {"'matcher' is '1'", "must be a section"});
    refused("matcher.cost=[1", {"--set matcher.cost", "no valid YAML"});
    refused("run.tile_size=-1", {"'run.tile_size' is '-1'", "from 0 to 1048576 or 'auto'"});
    place.refused_pair("left.tif", "right.tif", 2, {"run.threads", "'0'", "from 1 to 1024"},
                       {"--threads", "0"});
    place.refused_pair("left.tif", "right.tif", 2, {"run.memory", "8bananas", "8GiB"},
                       {"--memory", "8bananas"});
    place.refused_pair("left.tif", "right.tif", 2, {"run.device", "banana", "auto, cpu, cuda"},
                       {"--device", "banana"});
}

TEST_CASE("a benchmark that makes no sense is refused before it takes any time")
{
    const EarlierResult place;
    const std::string left = place / "left.tif";
    const std::string right = place / "right.tif";
    const auto refused = [&](std::vector<std::string> more, int code,
                             const std::vector<std::string>& words) {
        more.insert(more.begin(), "bench");
        place.refused(more, code, words);
    };
    refused({"--device", "cuda"}, 4, {"--device is 'cuda'", "no CUDA device", "auto or cpu"});
    refused({"--device", "cuda:1"}, 4, {"--device is 'cuda:1'"});
    refused({"--device", "banana"}, 2, {"'banana'", "auto, cpu, cuda or cuda:N"});
    refused({"--disparities", "100"}, 2, {"--disparities is 100", "multiple of 16"});
    refused({"--side", "256", "--disparities", "80"}, 2,
            {"80", "256 px", "a quarter of that, 64"});
    refused({"--side", "10"}, 2, {"--side", "64 to 65536"});
    refused({"--side", "60000", "--peers", "none"}, 4,
            {"of memory, and", "choose a smaller side"});
    refused({"--peers", "libsgm"}, 2, {"--peers", "hh, hh4, sgbm, 3way", "'libsgm'"});
    refused({"--cost", "census"}, 2, {"--cost", "census5x5", "'census'"});
    refused({"--instructions", "mmx"}, 2, {"--instructions", "avx512, avx2, sse4", "'mmx'"});
    refused({"--threads", "0"}, 2,
            {"--threads is '0'", "all, or whole numbers from 1 to 1024"});
    refused({"--repeats", "0"}, 2, {"--repeats", "1 to 1000"});
    refused({"--scene", "sea"}, 2, {"--scene", "town,towers"});
    refused({"--set", "run.threads=2"}, 2, {"--set run.threads=2", "keys of `matcher` alone"});
    refused({"--set", "matcher.pathes=4"}, 2, {"did you mean 'paths'?"});
    refused({left}, 2, {"RIGHT is missing"});
    refused({left, right}, 2, {"--disparity MIN,MAX"});
    refused({left, right, "--disparity", "0,15", "--side", "512"}, 2, {"neither --side nor"});
    refused({left, right, "--disparity", "15,0"}, 2, {"--disparity 15,0 is reversed"});
    refused({left, right, "--disparity", "5000,5015"}, 2, {"no left pixel has a counterpart"});
    refused({left, place / "none.tif", "--disparity", "0,15"}, 3, {"There is no file"});
    refused({"--disparity", "0,15"}, 2, {"takes --disparities N"});
}
