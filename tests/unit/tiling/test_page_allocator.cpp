#include "tiling/image.h"
#include "tiling/page_allocator.h"
#include "tiling/page_store.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <deque>
#include <random>
#include <thread>
#include <utility>
#include <vector>

using namespace hsgm::tiling;

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
        Image<std::uint16_t> image({1500, 2000});
        const auto pixels = image.pixels();
        CHECK(std::all_of(pixels.begin(), pixels.end(), [](int p) { return p == 0; }));
        std::fill_n(image.data(), pixels.size(), std::uint16_t{9});
    }
}

TEST_CASE("A freed block is used again")
{
    release_free_pages();
    void* const first = take_pages(5 << 20);
    CHECK(reinterpret_cast<std::uintptr_t>(first) % (2 << 20) == 0);
    give_pages(first, 5 << 20);
    void* const again = take_pages(5 << 20);
    CHECK(again == first);
    give_pages(again, 5 << 20);
    void* const smaller = take_pages(4 << 20); // its end goes back
    CHECK(smaller == first);
    CHECK(held_page_bytes() == 4 << 20);
    void* const small = take_pages(1 << 20); // not from a much larger one
    give_pages(smaller, 4 << 20);
    CHECK(held_page_bytes() == 5 << 20);
    give_pages(small, 1 << 20);
    release_free_pages();
    CHECK(held_page_bytes() == 0);
}

TEST_CASE("Blocks of all sizes, taken and freed over and over, never hold a tenth too much")
{
    release_free_pages();
    std::mt19937 random(1);
    std::deque<std::pair<std::uint8_t*, std::size_t>> alive;
    std::size_t used = 0;
    std::size_t most = 0;
    for (int i = 0; i < 5000; ++i) {
        const std::size_t bytes = (std::size_t{1} << 20) + random() % (std::size_t{12} << 20);
        alive.emplace_back(static_cast<std::uint8_t*>(take_pages(bytes)), bytes);
        alive.back().first[0] = 1;
        alive.back().first[bytes - 1] = 1;
        used += bytes;
        most = std::max(most, used);
        if (alive.size() > 12) {
            give_pages(alive.front().first, alive.front().second);
            used -= alive.front().second;
            alive.pop_front();
        }
        REQUIRE(held_page_bytes() <= most + most / 10 + 13 * (std::size_t{64} << 10));
    }
    for (const auto& [block, bytes] : alive) {
        give_pages(block, bytes);
    }
    release_free_pages();
    CHECK(held_page_bytes() == 0);
}

TEST_CASE("Threads that take and free side by side share what is free")
{
    release_free_pages();
    std::vector<std::thread> threads;
    std::atomic<int> wrong = 0;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([t, &wrong] {
            for (int i = 0; i < 300; ++i) {
                const std::size_t bytes = std::size_t(1 + (i + t) % 5) << 20;
                auto* const block = static_cast<std::uint8_t*>(take_pages(bytes));
                std::fill_n(block, bytes, static_cast<std::uint8_t>(t));
                wrong += std::count(block, block + bytes, t) != std::ptrdiff_t(bytes);
                give_pages(block, bytes);
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    CHECK(wrong == 0);
    CHECK(held_page_bytes() <= 4 * (5 << 20) * 11 / 10);
    release_free_pages();
    CHECK(held_page_bytes() == 0);
}
