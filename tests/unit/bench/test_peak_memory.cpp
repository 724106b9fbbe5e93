#include "tests/catch.h"

#include "pipeline/bench/peak_memory.h"

#include <vector>

using namespace hsgm::bench;

namespace {

constexpr std::int64_t kMiB = 1 << 20;

// Memory that is really there, then gone.
std::int64_t touch(std::int64_t bytes)
{
    const std::vector<char> block(static_cast<std::size_t>(bytes), 'x');
    return block[block.size() / 2];
}

} // namespace

TEST_CASE("a watch sees the peak since it began, not an earlier one")
{
    const PeakMemoryWatch large;
    REQUIRE(touch(200 * kMiB) == 'x');
    const auto first = large.peak();
    const PeakMemoryWatch small;
    REQUIRE(touch(50 * kMiB) == 'x');
    const auto second = small.peak();
    if (!first || !second) {
        WARN("the kernel does not let a process reset its peak of memory");
        return;
    }
    CHECK(first->added >= 195 * kMiB);
    CHECK(first->added < 300 * kMiB);
    CHECK(second->added >= 45 * kMiB);
    CHECK(second->added < 120 * kMiB);
    CHECK(second->peak >= second->added);
}

TEST_CASE("some memory is free, and no more than the machine can have")
{
    CHECK(free_memory_bytes() > 16 * kMiB);
    CHECK(free_memory_bytes() < std::int64_t{1} << 50);
}
