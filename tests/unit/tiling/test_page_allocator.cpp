#include "tiling/image.h"
#include "tiling/page_allocator.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

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
