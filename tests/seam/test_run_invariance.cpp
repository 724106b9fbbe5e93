#include "tests/catch.h"

#include "tests/seam/run_files.h"

#include "matcher/reasons.h"

#include <unistd.h>

#include <algorithm>

using namespace hsgm;
using namespace hsgm::seam;
using tiling::TileOrder;

namespace {

constexpr std::uint64_t kMiB = 1 << 20;

// Many small runs, and each waits for the disk until its results are safe: in memory, where
// the system has a file system there, that takes no time.
std::filesystem::path quick_folder()
{
    const std::filesystem::path memory = "/dev/shm";
    std::error_code error;
    const auto space = std::filesystem::space(memory, error);
    return !error && space.available > 256 * kMiB && ::access(memory.c_str(), W_OK) == 0
               ? memory
               : std::filesystem::temp_directory_path();
}

const StereoPair& town()
{
    static const StereoPair pair = render(city({200, 280}, 5));
    return pair;
}

} // namespace

TEST_CASE("a run's files are the same for every tiling, thread count, order and memory")
{
    const TemporaryFolder folder(quick_folder());
    const pipeline::Job job = write_pair(town(), Storage::uint8, folder.path());
    CHECK(differences_between(job, {{0, 1},
                                    {0, 2},
                                    {64, 1, TileOrder::shuffled},
                                    {64, 2, TileOrder::columns},
                                    {100, 2, TileOrder::shuffled},
                                    {100, 1, TileOrder::reversed},
                                    {256, 2, TileOrder::reversed},
                                    {1000, 2, TileOrder::shuffled},
                                    {std::nullopt, 2},
                                    {std::nullopt, 2, TileOrder::rows, 256 * kMiB}}) == "");
}

TEST_CASE("a run of 16-bit images gives the same files for every tiling")
{
    const TemporaryFolder folder(quick_folder());
    const pipeline::Job job = write_pair(town(), Storage::uint16, folder.path());
    CHECK(differences_between(job, {{0, 2},
                                    {64, 2, TileOrder::shuffled},
                                    {100, 1, TileOrder::columns},
                                    {std::nullopt, 1, TileOrder::rows, 256 * kMiB}}) == "");
}

TEST_CASE("a run of float images with holes and NaN gives the same files for every tiling")
{
    const TemporaryFolder folder(quick_folder());
    const pipeline::Job job = write_pair(town(), Storage::float32, folder.path());
    CHECK(differences_between(job, {{0, 2},
                                    {64, 2, TileOrder::shuffled},
                                    {100, 1, TileOrder::columns},
                                    {256, 2, TileOrder::reversed}}) == "");
    // The holes are there, and told.
    const auto reasons = run(job)[2].pixels;
    CHECK(std::count_if(reasons.begin(), reasons.end(), [](double bits) {
              return (static_cast<int>(bits) & matcher::kNodataLeft) != 0;
          }) > 100);
}

TEST_CASE("a run that fills its holes gives the same files for every tiling")
{
    const TemporaryFolder folder(quick_folder());
    pipeline::Job job = write_pair(town(), Storage::uint8, folder.path());
    job.matcher.speckle_px = 120;
    job.matcher.min_confidence = 160;
    job.matcher.fill = matcher::Fill::all;
    CHECK(differences_between(job, {{0, 1},
                                    {64, 2, TileOrder::shuffled},
                                    {100, 2, TileOrder::reversed},
                                    {std::nullopt, 2, TileOrder::rows, 256 * kMiB}}) == "");
    const auto reasons = run(job)[2].pixels;
    CHECK(std::count_if(reasons.begin(), reasons.end(), [](double bits) {
              return (static_cast<int>(bits) & matcher::kInterpolated) != 0;
          }) > 100);
}

TEST_CASE("runs of the other modes give the same files for every tiling")
{
    using matcher::Cost;
    using matcher::Mode;
    const TemporaryFolder folder(quick_folder());
    pipeline::Job job = write_pair(town(), Storage::uint16, folder.path());
    for (const auto& [mode, cost] : {std::pair{Mode::hsgm, Cost::hmi},
                                     {Mode::hsgm_paper, Cost::hmi},
                                     {Mode::sgm, Cost::census9x7},
                                     {Mode::local, Cost::census5x5}}) {
        INFO(name(mode));
        job.matcher.mode = mode;
        job.matcher.cost = cost;
        CHECK(differences_between(
                  job, {{0, 1}, {64, 2, TileOrder::shuffled}, {100, 2, TileOrder::columns}}) ==
              "");
    }
}
