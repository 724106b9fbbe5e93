#include "tests/refusals/earlier_result.h"

#include "tests/catch.h"

using namespace hsgm::tests;

TEST_CASE("what does not fit the memory is refused with what would do")
{
    EarlierResult place;
    make_pair(place.folder(), {400, 400});
    place.remember();
    place.refused_pair(
        "left.tif", "right.tif", 4,
        {"mode sgm", "needs", "MiB", "may take 100 MiB", "--memory", "mode hsgm"},
        {"--memory", "100MiB", "--set", "matcher.mode=sgm"});
    place.refused_pair("left.tif", "right.tif", 4,
                       {"mode hsgm", "needs", "may take 100 MiB", "--memory"},
                       {"--memory", "100MiB"});
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
                           {"run.device", "'" + device + "'", "no CUDA worker", "auto or cpu"},
                           {"--device", device});
    }
    put_bytes(place / "bad.yaml", pair_config() + "run: {device: cuda}\n");
    place.remember();
    place.refused({"run", place / "bad.yaml"}, 4, {"bad.yaml:5:15", "no CUDA worker"});
}
