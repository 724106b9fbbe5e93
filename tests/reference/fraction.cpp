#include "tests/reference/fraction.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace hsgm::reference {

std::bitset<16> sparse_census_at(const Image<std::uint16_t>& image, int row, int col)
{
    std::bitset<16> bits;
    std::size_t bit = 0;
    for (const int rows : {-3, -1, 1, 3}) {
        for (const int cols : {-3, -1, 1, 3}) {
            bits[bit++] = clamped(image, row + rows, col + cols) < image(row, col);
        }
    }
    return bits;
}

int differing_bits(const Image<std::uint16_t>& left, const Image<std::uint16_t>& right, int row,
                   int x, int disparity)
{
    const int counterpart = x - disparity;
    if (counterpart < 0 || counterpart >= right.cols() || right(row, counterpart) == kNodata) {
        return 8;
    }
    const auto differ =
        sparse_census_at(left, row, x) ^ sparse_census_at(right, row, counterpart);
    return static_cast<int>(differ.count());
}

std::int32_t census_fraction(const Image<std::uint16_t>& left,
                             const Image<std::uint16_t>& right, const Surface& surface,
                             DisparityRange asked, int row, int x)
{
    const int winner = surface.winners(row, x);
    const std::int32_t value = surface.q8(row, x);
    if (winner == asked.min || winner == asked.max) {
        return value;
    }
    const auto bits = [&](int disparity) {
        int sum = 0;
        for (const int rows : {-3, 0, 3}) {
            for (const int cols : {-3, 0, 3}) {
                if (surface.has(row + rows, x + cols) &&
                    std::abs(surface.winners(row + rows, x + cols) - winner) <= 1) {
                    sum += differing_bits(left, right, row + rows, x + cols, disparity);
                }
            }
        }
        return sum;
    };
    const int o = value - 256 * winner;
    const int middle = bits(winner);
    const int a = 128 * std::max(bits(winner - 1) - middle, 0) + 6 * (128 + std::min(o, 0));
    const int b = 128 * std::max(bits(winner + 1) - middle, 0) + 6 * (128 - std::max(o, 0));
    const int offset = 128 - 128 * std::min(a, b) / std::max(a, b);
    return a < b ? 256 * winner - std::min(offset, 127) : 256 * winner + offset;
}

std::uint8_t confidence_at(const Surface& surface, const Image<std::uint8_t>& margins, int row,
                           int x)
{
    constexpr std::array<int, 25> kTable{60,  71,  85,  102, 121, 140, 157, 174, 187,
                                         199, 211, 222, 230, 236, 241, 244, 247, 248,
                                         249, 250, 251, 252, 253, 254, 255};
    int score = 0;
    for (const int distance : {2, 5}) {
        for (const int rows : {-distance, 0, distance}) {
            for (const int cols : {-distance, 0, distance}) {
                if ((rows == 0 && cols == 0) || !surface.has(row + rows, x + cols)) {
                    continue;
                }
                const int apart =
                    std::abs(surface.q8(row + rows, x + cols) - surface.q8(row, x));
                score += 200 * ((apart <= 64 ? 1 : 0) + (apart <= 384 ? 1 : 0));
            }
        }
    }
    for (int r = row - 2; r <= row + 2; ++r) {
        for (int c = x - 2; c <= x + 2; ++c) {
            score += surface.has(r, c) ? margins(r, c) : 0;
        }
    }
    return static_cast<std::uint8_t>(kTable[static_cast<std::size_t>(score / 512)]);
}

} // namespace hsgm::reference
