#include "tests/runs/run_place.h"

#include "tests/catch.h"

#include <csignal>
#include <random>
#include <thread>

using namespace hsgm::tests;

TEST_CASE("a run killed at twenty random moments resumes to the same bits")
{
    const RunPlace place({600, 800});
    place.undisturbed();
    std::mt19937 random(4); // the moments differ from machine to machine anyhow
    int kills = 0;
    for (int attempt = 0; kills < 20 && attempt < 60; ++attempt) {
        const char* tile = attempt % 3 == 0 ? "64" : attempt % 3 == 1 ? "100" : "200";
        RunningProgram program(place.command({"--resume", "--tile-size", tile}));
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 900));
        if (program.has_ended()) {
            CHECK(program.wait().code == 0);
            CHECK((place.rasters() == place.undisturbed()));
            std::filesystem::remove_all(place.result());
            continue;
        }
        program.signal(SIGKILL);
        program.wait();
        ++kills;
    }
    CHECK(kills == 20);
    place.run_to(0, {"--resume"});
    CHECK((place.rasters() == place.undisturbed()));
}
