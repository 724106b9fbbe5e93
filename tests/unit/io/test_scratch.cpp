#include "io/error.h"
#include "io/scratch_folder.h"
#include "io/scratch_raster.h"
#include "tests/unit/io/sample_rasters.h"

#include <cstdint>
#include <stdexcept>
#include <thread>

using namespace hsgm::io;
using namespace hsgm::io::samples;
using Catch::Matchers::Contains;
using hsgm::tiling::Image;
using hsgm::tiling::Rect;
using hsgm::tiling::Size;

TEST_CASE("a scratch raster starts with its fill value everywhere")
{
    TemporaryFolder folder;
    // Larger than one chunk of the filling, and no multiple of it.
    ScratchRaster<std::uint32_t> raster(folder.path(), "keys", {700, 801}, 0xFFFF1234U);
    Image<std::uint32_t> all(raster.size());
    raster.read({0, 0, 700, 801}, all);
    CHECK(std::all_of(all.pixels().begin(), all.pixels().end(),
                      [](std::uint32_t v) { return v == 0xFFFF1234U; }));
    ScratchRaster<float> zeros(folder.path(), "zeros", {3, 3});
    Image<float> image({3, 3}, 7.0F);
    zeros.read({0, 0, 3, 3}, image);
    CHECK(image == Image<float>({3, 3}, 0.0F));
}

TEST_CASE("rectangles land where they belong and nowhere else")
{
    TemporaryFolder folder;
    ScratchRaster<std::int16_t> raster(folder.path(), "x", {4, 5}, std::int16_t{-1});
    Image<std::int16_t> source({3, 6});
    for (int i = 0; i < 18; ++i) {
        source(i / 6, i % 6) = static_cast<std::int16_t>(i);
    }
    raster.write({1, 2, 2, 3}, source.view().part({1, 1, 2, 3})); // rows apart in memory
    raster.write({3, 0, 1, 5}, source.view().part({0, 0, 1, 5})); // a whole row
    Image<std::int16_t> all({4, 5});
    raster.read({0, 0, 4, 5}, all);
    const std::vector<std::int16_t> expected{-1, -1, -1, -1, -1, -1, -1, 7, 8, 9,
                                             -1, -1, 13, 14, 15, 0,  1,  2, 3, 4};
    CHECK(std::vector<std::int16_t>(all.pixels().begin(), all.pixels().end()) == expected);
    Image<std::int16_t> part({3, 3});
    raster.read({2, 2, 2, 2}, part.view().part({1, 1, 2, 2}));
    CHECK(part(1, 1) == 13);
    CHECK(part(2, 2) == 3);
    CHECK(part(0, 0) == 0);
}

TEST_CASE("threads may fill disjoint rectangles side by side")
{
    TemporaryFolder folder;
    ScratchRaster<std::int32_t> raster(folder.path(), "x", {64, 64});
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&raster, t] {
            for (int row = 0; row < 64; ++row) {
                const Image<std::int32_t> run({1, 16}, row * 4 + t);
                raster.write({row, t * 16, 1, 16}, run.view());
            }
        });
    }
    threads.clear();
    Image<std::int32_t> all({64, 64});
    raster.read({0, 0, 64, 64}, all);
    int wrong = 0;
    for (int row = 0; row < 64; ++row) {
        for (int col = 0; col < 64; ++col) {
            wrong += all(row, col) != row * 4 + col / 16 ? 1 : 0;
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE("a scratch raster takes its room at once and gives it back")
{
    TemporaryFolder folder;
    {
        ScratchRaster<float> raster(folder.path(), "x", {100, 100});
        ScratchRaster<float> moved(std::move(raster));
        CHECK(std::filesystem::file_size(folder / "x") == 40000);
        CHECK_THROWS_AS(ScratchRaster<float>(folder.path(), "x", {1, 1}), StorageError);
    }
    CHECK(folder.names().empty());
}

TEST_CASE("a scratch raster larger than the disk is refused with both sizes")
{
    TemporaryFolder folder;
    const auto attempt = [&] {
        ScratchRaster<double>(folder.path(), "huge", {1 << 24, 1 << 24}); // 2 PiB
    };
    CHECK_THROWS_AS(attempt(), StorageError);
    CHECK_THROWS_WITH(attempt(), Contains("needs 2251799813685248 bytes") && Contains("free"));
    CHECK(folder.names().empty());
}

TEST_CASE("reading a scratch file that somebody shortened is an error, not garbage")
{
    TemporaryFolder folder;
    ScratchRaster<float> raster(folder.path(), "x", {10, 10});
    std::filesystem::resize_file(folder / "x", 100);
    Image<float> all({10, 10});
    CHECK_THROWS_AS(raster.read({0, 0, 10, 10}, all), StorageError);
}

TEST_CASE("a scratch folder goes with its content, also when a run dies")
{
    TemporaryFolder folder;
    try {
        const ScratchFolder scratch(folder.path());
        put_bytes((scratch.path() / "leftover").string(), "x");
        CHECK_THAT(scratch.path().filename().string(),
                   Catch::Matchers::StartsWith(".hsgm-scratch-"));
        CHECK(folder.names().size() == 1);
        throw std::runtime_error("the run dies");
    } catch (const std::runtime_error&) {
        CHECK(folder.names().empty());
    }
    CHECK_THROWS_AS(ScratchFolder(folder.path() / "absent"), StorageError);
}

TEST_CASE("a kept scratch raster can be opened again, and one of another length cannot")
{
    TemporaryFolder folder;
    const Size size{3, 4};
    Image<std::uint16_t> source(size, std::uint16_t{7});
    {
        ScratchRaster<std::uint16_t> raster(folder.path(), "x", size, std::uint16_t{0},
                                            ScratchLife::kept);
        raster.write({0, 0, 3, 4}, source.view());
        raster.sync();
    }
    Image<std::uint16_t> read(size);
    ScratchRaster<std::uint16_t>(folder.path(), "x", size, std::uint16_t{0},
                                 ScratchLife::existing)
        .read({0, 0, 3, 4}, read);
    CHECK(read == source);
    CHECK(folder.names() == std::vector<std::string>{"x"});
    const auto open = [&](const char* name, Size asked) {
        ScratchRaster<std::uint16_t>(folder.path(), name, asked, std::uint16_t{0},
                                     ScratchLife::existing);
    };
    CHECK_THROWS_WITH(open("x", {3, 5}), Contains("has 24 bytes instead of 30"));
    CHECK_THROWS_WITH(open("y", {3, 5}), Contains("Cannot open the scratch file"));
}
