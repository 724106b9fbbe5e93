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

/// Section 3's table: the neighbourhood that bits compare, and C_max.
struct CostRule {
    int rows;
    int cols;
    std::uint32_t max;
};
CostRule rule(Cost cost);

using CensusBits = std::bitset<64>;
/// One bit a neighbour, row by row: is the neighbour below the centre?
CensusBits census_at(const Image<std::uint16_t>& image, int row, int col, int rows, int cols);
/// Pairs of touching pixels, the 52 and then the 12.
CensusBits pairs_at(const Image<std::uint16_t>& image, int row, int col);
/// Two bits a neighbour of the 5 x 5: below the centre by more than `t`, and above.
CensusBits ternary_at(const Image<std::uint16_t>& image, int row, int col, int t);

/// The clipped gradient along rows, 0..30, from the tones of an image.
int gradient_at(const Image<std::uint16_t>& image, const Image<std::uint8_t>& tone, int row,
                int col);

/// A map of either image, for BT.
struct Sampled {
    int value;
    int least; ///< within half a pixel
    int most;
};
/// BT of two samples.
int sampling_difference(const Sampled& left, const Sampled& right);

/// The images of one level, and what the costs and penalties read of them.
struct LevelPair {
    Cost cost;
    Image<std::uint16_t> left;
    Image<std::uint16_t> right;
    Image<std::uint8_t> tone_left;
    Image<std::uint8_t> tone_right;
    Image<CensusBits> census_left; ///< costs that count bits, like census_right
    Image<CensusBits> census_right;
    Image<Sampled> gradient_left; ///< costs of Birchfield and Tomasi, like the next three
    Image<Sampled> gradient_right;
    Image<Sampled> sampled_tone_left;
    Image<Sampled> sampled_tone_right;
    const HmiCosts* hmi = nullptr; ///< borrowed; cost `hmi` only
};

LevelPair make_level_pair(const Image<std::uint16_t>& left, const Image<std::uint16_t>& right,
                          ToneEnds ends_left, ToneEnds ends_right, Cost cost,
                          const HmiCosts* hmi);

/// Section 3: C(p, d) of p = (row, x), without the prior.
std::uint32_t matching_cost(const LevelPair& pair, int row, int x, int d);

/// range7(p) < 7: the tones of the valid pixels of the 7 x 7 neighbourhood hardly differ.
/// False for a nodata pixel.
bool is_flat(const LevelPair& pair, int row, int col);

/// q(P, D) of one coarse pixel over its stored range, from its S.
PixelCosts prior_of(const PixelCosts& coarse_sums, int paths);
/// prior(p, d) from q(P, .) of P = floor(p / 2).
std::uint32_t prior_at(const PixelCosts& q, int d);

} // namespace hsgm::reference
