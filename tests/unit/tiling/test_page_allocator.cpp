#include "tiling/image.h"
#include "tiling/page_allocator.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <random>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

using hsgm::tiling::PageAllocator;

TEST_CASE("Pixels start at an address that suits any vector")
{
    for (const std::size_t count : {std::size_t{1}, std::size_t{1000}, std::size_t{5} << 20}) {
        std::vector<std::uint16_t, PageAllocator<std::uint16_t>> pixels(count, 7);
        CHECK(reinterpret_cast<std::uintptr_t>(pixels.data()) % 128 == 0);
        CHECK(std::count(pixels.begin(), pixels.end(), 7) == std::ptrdiff_t(count));
    }
}

TEST_CASE("An image without a value to fill it with is zero, whatever lay there before")
{
    for (int i = 0; i < 2; ++i) {
        hsgm::tiling::Image<std::uint16_t> image({1500, 2000});
        const auto pixels = image.pixels();
        CHECK(std::all_of(pixels.begin(), pixels.end(), [](int p) { return p == 0; }));
        std::fill_n(image.data(), pixels.size(), std::uint16_t{9});
    }
}

#ifdef __GLIBC__
TEST_CASE("Tile after tile finds room in what earlier ones left")
{
    using Pixels = std::vector<std::uint16_t, PageAllocator<std::uint16_t>>;
    // As the program sets it (pipeline/freed_memory.h): all from one heap, which keeps it.
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_ARENA_MAX, 1);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    std::mt19937 random(1);
    std::deque<Pixels> alive;
    std::deque<std::vector<int>> small;
    std::size_t most = 0; // bytes alive
    std::size_t heap = 0;
    for (int i = 0; i < 2000; ++i) {
        alive.emplace_back(random() % (std::size_t{6} << 20)); // up to 12 MiB
        small.emplace_back(random() % 2000);
        if (alive.size() > 12) {
            alive.pop_front();
        }
        if (small.size() > 200) {
            small.pop_front();
        }
        std::size_t bytes = 0;
        for (const Pixels& pixels : alive) {
            bytes += 2 * pixels.size();
        }
        most = std::max(most, bytes);
        heap = mallinfo2().arena;
    }
    CAPTURE(most >> 20, heap >> 20);
    CHECK(heap < most / 2 * 5);
}
#endif
