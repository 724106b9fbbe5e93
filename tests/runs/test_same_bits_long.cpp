#include "tests/runs/same_bits.h"

#include "tests/catch.h"

using namespace hsgm::tests;

TEST_CASE("every output of a large pair has one SHA-256 for any threads, memory and shards")
{
    SameBits same("[3000, 4500]", "[-300, 1747]");
    for (const char* threads : {"1", "2", "4"}) {
        for (const char* memory : {"512MiB", "1GiB", "4GiB"}) {
            same.run({"--threads", threads, "--memory", memory});
        }
    }
    for (const int shards : {1, 3, 7}) {
        same.run_in_shards(shards, {"--threads", "2", "--memory", "512MiB"});
    }
}

TEST_CASE("every output of two raw images of megapixels has one SHA-256 for any threads, "
          "memory and shards")
{
    SameBits same("[2700, 2700]");
    for (const char* threads : {"1", "2", "4"}) {
        same.run({"--threads", threads});
    }
    for (const char* memory : {"512MiB", "1GiB", "4GiB"}) {
        same.run({"--threads", "2", "--memory", memory});
    }
    for (const int shards : {1, 3, 7}) {
        same.run_in_shards(shards, {"--threads", "2", "--memory", "512MiB"});
    }
}
