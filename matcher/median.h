#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace hsgm::matcher {

/// The middle one of nine values, by the least sorting network that finds it: 19 exchanges
/// without a branch (Paeth, Graphics Gems 1990; Devillard 1998).
template <typename T>
constexpr T median_of_nine(std::array<T, 9> v)
{
    const auto exchange = [&v](std::size_t a, std::size_t b) {
        const T low = std::min(v[a], v[b]);
        v[b] = std::max(v[a], v[b]);
        v[a] = low;
    };
    exchange(1, 2), exchange(4, 5), exchange(7, 8);
    exchange(0, 1), exchange(3, 4), exchange(6, 7);
    exchange(1, 2), exchange(4, 5), exchange(7, 8);
    exchange(0, 3), exchange(5, 8), exchange(4, 7);
    exchange(3, 6), exchange(1, 4), exchange(2, 5);
    exchange(4, 7), exchange(4, 2), exchange(6, 4);
    exchange(4, 2);
    return v[4];
}

} // namespace hsgm::matcher
