#include "tests/faults/small_disk.h"
#include "tests/runs/run_place.h"

#include "tests/catch.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

constexpr int kDiskMiB = 32;

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

// Rasters that are not whole are not there.
void check_what_is_there(const RunPlace& place)
{
    for (const auto& [name, bytes] : place.rasters()) {
        INFO(name);
        CHECK((bytes == place.undisturbed().at(name)));
    }
}

// Fills the disk to the last byte once a run is so far; then makes room, and resumes.
void fills_up(const std::function<bool(const RunPlace&)>& is_so_far)
{
    SmallDisk disk(kDiskMiB);
    if (!disk.mounted()) {
        return;
    }
    const RunPlace place(disk.folder() / "result", {600, 800}, 63);
    place.undisturbed();
    {
        RunningProgram program(place.command());
        REQUIRE(comes_true([&] { return program.has_ended() || is_so_far(place); }));
        program.signal(SIGSTOP);
        fill(disk, 0);
        program.signal(SIGCONT);
        const Outcome outcome = program.wait();
        INFO(outcome.err);
        CHECK(outcome.code == 6);
        CHECK_THAT(outcome.err,
                   Contains("disk is full") || Contains("No space left on device"));
    }
    check_what_is_there(place);
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
    fills_up([](const RunPlace& place) { return place.done() > 0; });
}

TEST_CASE("a run whose disk fills up while it writes its results can be resumed")
{
    fills_up([](const RunPlace& place) {
        std::error_code none; // the folder comes with the run
        const fs::directory_iterator results(place.result(), none);
        return std::any_of(begin(results), end(results), [](const fs::directory_entry& entry) {
            return entry.path().filename().string().starts_with(".disparity.part-");
        });
    });
}
