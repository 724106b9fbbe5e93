#pragma once

#include <array>
#include <span>

namespace hsgm::matcher::host {

/// A path direction r: the step from a pixel's predecessor to the pixel.
struct Direction {
    int row;
    int col;
};

/// The directions of 4, 5, 8 or 16 paths. Their order has no influence on any result.
inline std::span<const Direction> directions(int paths)
{
    static constexpr std::array<Direction, 16> kSixteen{{{0, 1},
                                                         {0, -1},
                                                         {1, 0},
                                                         {-1, 0},
                                                         {1, 1},
                                                         {1, -1},
                                                         {-1, 1},
                                                         {-1, -1},
                                                         {1, 2},
                                                         {1, -2},
                                                         {-1, 2},
                                                         {-1, -2},
                                                         {2, 1},
                                                         {2, -1},
                                                         {-2, 1},
                                                         {-2, -1}}};
    static constexpr std::array<Direction, 5> kFive{{{0, 1}, {0, -1}, {1, 0}, {1, 1}, {1, -1}}};
    if (paths == 5) {
        return kFive;
    }
    return std::span(kSixteen).first(static_cast<std::size_t>(paths));
}

} // namespace hsgm::matcher::host
