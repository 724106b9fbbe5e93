#include "tests/refusals/earlier_result.h"

#include "tests/catch.h"

#include <chrono>
#include <csignal>
#include <functional>
#include <thread>

using namespace hsgm::tests;

namespace {

bool comes_true(const std::function<bool()>& condition)
{
    for (int i = 0; i < 6000; ++i) {
        if (condition()) {
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

} // namespace

TEST_CASE("a run that is interrupted keeps the earlier outputs and removes its scratch")
{
    EarlierResult place;
    make_pair(place.folder(), {600, 600});
    place.remember();
    const Snapshot before = snapshot(place.folder().path().string());
    for (const int number : {SIGINT, SIGTERM}) {
        RunningProgram program({hsgm_program(), "match", place / "left.tif",
                                place / "right.tif", "-o", place / "d.tif", "--disparity",
                                "0,400", "--tile-size", "64", "--set", "matcher.prune=false"});
        REQUIRE(comes_true([&] { return program.err().find("tiles, ") != std::string::npos; }));
        program.signal(number);
        const Outcome outcome = program.wait();
        CHECK(outcome.code == 130);
        CHECK_THAT(outcome.err, Catch::Matchers::Contains("error: interrupted"));
        CHECK((snapshot(place.folder().path().string()) == before));
    }
}

TEST_CASE("a synthesis that is interrupted leaves no part of a raster")
{
    const TemporaryFolder folder;
    put_bytes(folder / "scene.yaml", "size: [20000, 20000]\n");
    RunningProgram program(
        {hsgm_program(), "synth", folder / "scene.yaml", "-o", folder / "scene"});
    const auto parts = [&] { return snapshot(folder.path().string()).size(); };
    REQUIRE(comes_true([&] { return parts() > 2; }));
    program.signal(SIGINT);
    CHECK(program.wait().code == 130);
    CHECK(names_in(snapshot(folder.path().string())) ==
          std::vector<std::string>{"scene.yaml", "scene/"});
}
