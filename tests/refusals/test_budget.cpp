#include "tests/refusals/earlier_result.h"

#include "tests/catch.h"

using namespace hsgm::tests;

TEST_CASE("what does not fit the memory is refused with what would do")
{
    EarlierResult place;
    make_pair(place.folder(), {400, 400});
    place.remember();
    const auto refused = [&](const std::string& memory, const std::string& more,
                             const std::string& disparity,
                             const std::vector<std::string>& words) {
        return place.refused_pair(
            "left.tif", "right.tif", 4, words,
            {"--memory", memory, "--threads", "2", "--set", more, "--disparity", disparity});
    };
    refused("200MiB", "matcher.mode=sgm", "0,300",
            {"mode sgm", "needs", "may take 200 MiB", "--memory", "use mode hsgm"});
    refused("200MiB", "matcher.window=1024", "0,300",
            {"mode hsgm", "2 threads", "may take 200 MiB", "use fewer threads"});
    // What every run takes: only more memory helps.
    CHECK_THAT(refused("100MiB", "matcher.mode=sgm", "0,300", {"may take 100 MiB", "--memory"}),
               Catch::Matchers::EndsWith("allow more with --memory"));
    put_bytes(place / "bad.yaml", pair_config() + "run: {memory: 10MiB}\n");
    place.remember();
    place.refused({"run", place / "bad.yaml"}, 4, {"may take 10 MiB", "--memory"});
    place.refused({"plan", place / "bad.yaml"}, 4, {"may take 10 MiB", "--memory"});
}

TEST_CASE("a device that is not there is refused")
{
    EarlierResult place;
    for (const std::string device : {"cuda", "cuda:1"}) {
        place.refused_pair("left.tif", "right.tif", 4,
                           {"run.device", "'" + device + "'", "no CUDA device", "auto or cpu"},
                           {"--device", device});
    }
    put_bytes(place / "bad.yaml", pair_config() + "run: {device: cuda}\n");
    place.remember();
    place.refused({"run", place / "bad.yaml"}, 4, {"bad.yaml:5:15", "no CUDA device"});
}
