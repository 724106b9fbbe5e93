#pragma once

#include "tests/reference/pyramid.h"

#include <bitset>
#include <cstdint>

namespace hsgm::reference {

/// Step 6 of section 6: one bit for each of the sixteen neighbours, row by row.
std::bitset<16> sparse_census_at(const Image<std::uint16_t>& image, int row, int col);

/// h(p, D): differing bits, 8 where there is no right pixel to compare with.
int differing_bits(const Image<std::uint16_t>& left, const Image<std::uint16_t>& right, int row,
                   int x, int disparity);

/// The pixels that have a value, and their values and winners.
struct Surface {
    Image<std::int32_t> q8;
    Image<int> winners;
    Image<std::uint8_t> has_value;

    bool has(int row, int col) const
    {
        return tiling::rect_of(q8.size()).contains(row, col) && has_value(row, col) != 0;
    }
};

/// The value that step 6 gives to a pixel that has one.
std::int32_t census_fraction(const Image<std::uint16_t>& left,
                             const Image<std::uint16_t>& right, const Surface& surface,
                             DisparityRange asked, int row, int x);

/// Step 7: the confidence of a pixel that has a value, from the margins m of all.
std::uint8_t confidence_at(const Surface& surface, const Image<std::uint8_t>& margins, int row,
                           int x);

} // namespace hsgm::reference
