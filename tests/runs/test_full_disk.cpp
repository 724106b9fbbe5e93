#include "tests/faults/small_disk.h"
#include "tests/runs/run_place.h"

#include "tests/catch.h"

#include <csignal>
#include <filesystem>
#include <fstream>

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

constexpr int kDiskMiB = 12;

// Takes all room of the disk but so much.
void fill(const SmallDisk& disk, std::int64_t leave_bytes)
{
    const auto free = static_cast<std::int64_t>(fs::space(disk.folder().path()).available);
    std::ofstream file(disk.folder() / "filler", std::ios::binary);
    const std::string zeros(4096, '\0');
    for (std::int64_t i = 0; i < free - leave_bytes; i += 4096) {
        file << zeros;
    }
}

// Fills the disk while a run is at work on its tiles; then makes room, and resumes.
void fills_up(std::int64_t leave_bytes, const std::string& words)
{
    SmallDisk disk(kDiskMiB);
    if (!disk.mounted()) {
        return;
    }
    const RunPlace place(disk.folder() / "result", {300, 400}, 255);
    place.undisturbed();
    {
        RunningProgram program(place.command());
        REQUIRE(comes_true([&] { return program.has_ended() || place.done() > 0; }));
        program.signal(SIGSTOP);
        fill(disk, leave_bytes);
        program.signal(SIGCONT);
        const Outcome outcome = program.wait();
        INFO(outcome.err);
        CHECK(outcome.code == 6);
        CHECK_THAT(outcome.err, Contains(words));
    }
    CHECK(place.rasters().empty());
    fs::remove(disk.folder() / "filler");
    place.run_to(0, {"--resume"});
    CHECK((place.rasters() == place.undisturbed()));
}

} // namespace

TEST_CASE("a disk too small for a run is refused before anything is written")
{
    SmallDisk disk(1);
    if (!disk.mounted()) {
        return;
    }
    const RunPlace place(disk.folder() / "result", {300, 400}, 31);
    const Outcome outcome = place.run_to(6);
    CHECK_THAT(outcome.err, Contains("needs 3 MiB") && Contains("between its stages"));
    CHECK_FALSE(fs::exists(place.result() + "/ledger"));
}

TEST_CASE("a run whose disk fills up while it matches can be resumed")
{
    fills_up(0, "disk is full");
}

TEST_CASE("a run whose disk fills up while it writes its results can be resumed")
{
    fills_up(100 << 10, "No space left on device");
}
