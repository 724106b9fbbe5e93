#pragma once

#include "tests/reference/pyramid.h"

#include <bitset>
#include <cstdint>
#include <vector>

namespace hsgm::reference {

/// Numbers of one pixel over a range of disparities.
struct PixelCosts {
    DisparityRange range;
    std::vector<std::uint32_t> values;

    PixelCosts() = default;
    explicit PixelCosts(DisparityRange r, std::uint32_t fill = 0)
        : range(r), values(static_cast<std::size_t>(r.count()), fill)
    {
    }
    std::uint32_t& at(int d) { return values[static_cast<std::size_t>(d - range.min)]; }
    std::uint32_t at(int d) const { return values[static_cast<std::size_t>(d - range.min)]; }
    std::uint32_t least() const;
    bool operator==(const PixelCosts&) const = default;
};

/// hmi_table(tone of the left pixel, tone of the right pixel) = cost 0..48.
using HmiCosts = Image<std::uint8_t>;

/// The columns of section 3's table.
struct CostRule {
    int rows;
    int cols;
    std::uint32_t max;
};
CostRule rule(Cost cost);

/// One bit a neighbour, row by row: is the neighbour below the centre?
using CensusBits = std::bitset<64>;
CensusBits census_at(const Image<std::uint16_t>& image, int row, int col, int rows, int cols);

/// The images of one level, and what the costs and penalties read of them.
struct LevelPair {
    Cost cost;
    Image<std::uint16_t> left;
    Image<std::uint16_t> right;
    Image<std::uint8_t> tone_left;
    Image<std::uint8_t> tone_right;
    Image<CensusBits> census_left; ///< left empty for cost `hmi`, like census_right
    Image<CensusBits> census_right;
    const HmiCosts* hmi = nullptr; ///< borrowed; cost `hmi` only
};

LevelPair make_level_pair(const Image<std::uint16_t>& left, const Image<std::uint16_t>& right,
                          ToneEnds ends_left, ToneEnds ends_right, Cost cost,
                          const HmiCosts* hmi);

/// Section 3: C(p, d) of p = (row, x), without the prior.
std::uint32_t matching_cost(const LevelPair& pair, int row, int x, int d);

/// range7(p) < 6: the tones of the valid pixels of the 7 x 7 neighbourhood hardly differ.
/// False for a nodata pixel.
bool is_flat(const LevelPair& pair, int row, int col);

/// q(P, D) of one coarse pixel over its stored range, from its S.
PixelCosts prior_of(const PixelCosts& coarse_sums, int paths);
/// prior(p, d) from q(P, .) of P = floor(p / 2).
std::uint32_t prior_at(const PixelCosts& q, int d);

} // namespace hsgm::reference
