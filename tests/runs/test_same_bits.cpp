#include "tests/runs/same_bits.h"

#include "tests/catch.h"

#include <utility>

using namespace hsgm::tests;

// The long version, with larger images, is test_same_bits_long.cpp; processor and device
// together: tests/cuda/test_runs.cpp.

TEST_CASE("every output has one SHA-256 for any threads, memory and shards")
{
    SameBits same("[1100, 2400]", "[-200, 1847]"); // so many disparities need memory
    std::vector<int> tiles;
    for (const auto& [threads, memory] :
         {std::pair{"4", "512MiB"}, {"2", "1GiB"}, {"1", "4GiB"}}) {
        const std::vector<std::string> words{"--threads", threads, "--memory", memory};
        same.run(words);
        tiles.push_back(same.tile_size(words));
    }
    CHECK(tiles[0] < tiles[1]);
    CHECK(tiles[1] < tiles[2]);
    // Neither the range nor the result shrinks: what does not fit is refused.
    same.refused({"--threads", "2", "--memory", "512MiB", "--tile-size", "0"});
    same.refused({"--threads", "2", "--memory", "1GiB", "--set", "matcher.mode=sgm"});
    same.run_in_shards(3, {"--threads", "2", "--memory", "1GiB"});
}

TEST_CASE("every output of a raw pair has one SHA-256 for any threads, memory and shards")
{
    SameBits same("[300, 300]");
    same.run({"--threads", "1", "--memory", "512MiB"});
    same.run({"--threads", "4", "--memory", "4GiB", "--tile-size", "100"});
    same.run_in_shards(3, {"--threads", "2", "--memory", "1GiB"});
}
