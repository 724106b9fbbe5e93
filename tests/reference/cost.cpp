#include "tests/reference/cost.h"

#include "tests/reference/ensure.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace hsgm::reference {

std::uint32_t PixelCosts::least() const
{
    return *std::min_element(values.begin(), values.end());
}

CostRule rule(Cost cost)
{
    switch (cost) {
    case Cost::census5x5:
    case Cost::ternary5x5:
        return {5, 5, 48};
    case Cost::census7x7:
        return {7, 7, 48};
    case Cost::census9x7: // 7 rows, 9 columns
        return {7, 9, 59};
    case Cost::pairs5x5:
    case Cost::census_ad:
    case Cost::pairs_bt:
        return {5, 5, 59};
    case Cost::birchfield_tomasi:
        return {1, 1, 58};
    case Cost::hmi:
        return {1, 1, 48};
    }
    throw std::logic_error("no such cost");
}

CensusBits census_at(const Image<std::uint16_t>& image, int row, int col, int rows, int cols)
{
    CensusBits bits;
    std::size_t bit = 0;
    for (int i = -(rows / 2); i <= rows / 2; ++i) {
        for (int j = -(cols / 2); j <= cols / 2; ++j) {
            bits[bit++] = clamped(image, row + i, col + j) < image(row, col);
        }
    }
    return bits;
}

CensusBits pairs_at(const Image<std::uint16_t>& image, int row, int col)
{
    const auto is_below = [&](int row_b, int col_b, int row_a, int col_a) {
        const int b = clamped(image, row + row_b, col + col_b);
        const int a = clamped(image, row + row_a, col + col_a);
        return a != kNodata && b != kNodata && b < a;
    };
    const auto in_block = [](int i, int j) { return std::abs(i) <= 1 && std::abs(j) <= 1; };
    CensusBits bits;
    std::size_t bit = 0;
    // All pixels in reading order, each with those after it that it touches.
    for (int i = -2; i <= 2; ++i) {
        for (int j = -2; j <= 2; ++j) {
            for (const auto& [down, right] : {std::pair{0, 1}, {1, -1}, {1, 0}, {1, 1}}) {
                const int k = i + down;
                const int l = j + right;
                if (in_block(i, j)) {
                    bits[bit++] = is_below(k, l, i, j);
                } else if (in_block(k, l)) {
                    bits[bit++] = is_below(i, j, k, l);
                }
            }
        }
    }
    ensure(bit == 52, "52 pairs touch");
    for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
            if (in_block(i, j + 1)) {
                bits[bit++] = is_below(i, j, i, j + 1);
            }
            if (in_block(i + 1, j)) {
                bits[bit++] = is_below(i, j, i + 1, j);
            }
        }
    }
    ensure(bit == 64, "12 of them share a side in the block");
    return bits;
}

CensusBits ternary_at(const Image<std::uint16_t>& image, int row, int col, int t)
{
    CensusBits bits;
    const int centre = image(row, col);
    std::size_t bit = 0;
    for (int i = -2; i <= 2; ++i) {
        for (int j = -2; j <= 2; ++j) {
            const int n = clamped(image, row + i, col + j);
            bits[bit++] = n != kNodata && n + t < centre;
            bits[bit++] = n != kNodata && centre + t < n;
        }
    }
    return bits;
}

int gradient_at(const Image<std::uint16_t>& image, const Image<std::uint8_t>& tone, int row,
                int col)
{
    const auto difference = [&](int r) {
        if (clamped(image, r, col - 1) == kNodata || clamped(image, r, col + 1) == kNodata) {
            return 0;
        }
        return clamped(tone, r, col + 1) - clamped(tone, r, col - 1);
    };
    const int sum = 2 * difference(row) + difference(row - 1) + difference(row + 1);
    return std::clamp(sum, -15, 15) + 15;
}

int sampling_difference(const Sampled& left, const Sampled& right)
{
    const int of_left = std::max({left.value - right.most, right.least - left.value, 0});
    const int of_right = std::max({right.value - left.most, left.least - right.value, 0});
    return std::min(of_left, of_right);
}

namespace {

template <typename T, typename At>
Image<T> map_of(Size size, At at)
{
    Image<T> result(size);
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            result(row, col) = at(row, col);
        }
    }
    return result;
}

bool counts_bits(Cost cost)
{
    return cost != Cost::hmi && cost != Cost::birchfield_tomasi;
}

Image<CensusBits> census_of(const Image<std::uint16_t>& image, ToneEnds ends, Cost cost)
{
    const CostRule window = rule(cost);
    return map_of<CensusBits>(image.size(), [&](int row, int col) {
        switch (cost) {
        case Cost::pairs5x5:
        case Cost::pairs_bt:
            return pairs_at(image, row, col);
        case Cost::ternary5x5:
            return ternary_at(image, row, col,
                              ends.noise > 0 ? (ends.hi - ends.lo + 127) / 255 : 0);
        default:
            return census_at(image, row, col, window.rows, window.cols);
        }
    });
}

/// The samples of a map, for which a neighbour outside the image or nodata has the pixel's
/// own value.
Image<Sampled> samples_of(const Image<std::uint16_t>& image, const Image<int>& map)
{
    return map_of<Sampled>(image.size(), [&](int row, int col) {
        const int value = map(row, col);
        Sampled sample{value, value, value};
        for (const int beside : {col - 1, col + 1}) {
            if (beside >= 0 && beside < image.cols() && image(row, beside) != kNodata) {
                const int mean = (value + map(row, beside) + 1) / 2;
                sample.least = std::min(sample.least, mean);
                sample.most = std::max(sample.most, mean);
            }
        }
        return sample;
    });
}

Image<Sampled> gradients_of(const Image<std::uint16_t>& image, const Image<std::uint8_t>& tone)
{
    return samples_of(image, map_of<int>(image.size(), [&](int row, int col) {
                          return gradient_at(image, tone, row, col);
                      }));
}

Image<Sampled> tones_of(const Image<std::uint16_t>& image, const Image<std::uint8_t>& tone)
{
    return samples_of(image, map_of<int>(image.size(), [&](int row, int col) {
                          return int{tone(row, col)};
                      }));
}

/// Whether p and its counterpart both have a value.
bool has_values(const LevelPair& pair, int row, int x, int xr)
{
    return xr >= 0 && xr < pair.right.cols() && pair.left(row, x) != kNodata &&
           pair.right(row, xr) != kNodata;
}

/// Sum of e over the 3 x 3 pixels round p.
int block_difference(const LevelPair& pair, int row, int x, int d)
{
    int sum = 0;
    for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
            const int r = std::clamp(row + i, 0, pair.left.rows() - 1);
            const int c = std::clamp(x + j, 0, pair.left.cols() - 1);
            if (!has_values(pair, r, c, c - d)) {
                sum += 13;
                continue;
            }
            const int g =
                sampling_difference(pair.gradient_left(r, c), pair.gradient_right(r, c - d));
            const int h = sampling_difference(pair.sampled_tone_left(r, c),
                                              pair.sampled_tone_right(r, c - d));
            sum += std::min(2 * g + h / 4, 26);
        }
    }
    return sum;
}

/// Costs that count `hamming` differing bits.
int cost_of_bits(const LevelPair& pair, int row, int x, int xr, int hamming)
{
    switch (pair.cost) {
    case Cost::census5x5:
        return 2 * hamming;
    case Cost::census_ad: {
        const int a = std::abs(pair.tone_left(row, x) - pair.tone_right(row, xr));
        return std::min(2 * hamming + std::min(a, 24) / 2, 59);
    }
    case Cost::pairs_bt: {
        const int g =
            sampling_difference(pair.gradient_left(row, x), pair.gradient_right(row, xr));
        return std::min((3 * hamming + 2 * g + g / 2) / 4, 59);
    }
    default:
        return std::min(hamming, static_cast<int>(rule(pair.cost).max));
    }
}

} // namespace

LevelPair make_level_pair(const Image<std::uint16_t>& left, const Image<std::uint16_t>& right,
                          ToneEnds ends_left, ToneEnds ends_right, Cost cost,
                          const HmiCosts* hmi)
{
    LevelPair pair;
    pair.cost = cost;
    pair.left = left;
    pair.right = right;
    pair.tone_left = toned(left, ends_left);
    pair.tone_right = toned(right, ends_right);
    if (cost == Cost::hmi) {
        ensure(hmi != nullptr, "cost hmi has a table");
        pair.hmi = hmi;
    }
    if (counts_bits(cost)) {
        pair.census_left = census_of(left, ends_left, cost);
        pair.census_right = census_of(right, ends_right, cost);
    }
    if (cost == Cost::pairs_bt || cost == Cost::birchfield_tomasi) {
        pair.gradient_left = gradients_of(left, pair.tone_left);
        pair.gradient_right = gradients_of(right, pair.tone_right);
        pair.sampled_tone_left = tones_of(left, pair.tone_left);
        pair.sampled_tone_right = tones_of(right, pair.tone_right);
    }
    return pair;
}

std::uint32_t matching_cost(const LevelPair& pair, int row, int x, int d)
{
    const int xr = x - d;
    if (!has_values(pair, row, x, xr)) {
        return rule(pair.cost).max / 2;
    }
    if (pair.cost == Cost::hmi) {
        return (*pair.hmi)(pair.tone_left(row, x), pair.tone_right(row, xr));
    }
    if (pair.cost == Cost::birchfield_tomasi) {
        return static_cast<std::uint32_t>(block_difference(pair, row, x, d) / 4);
    }
    const auto hamming =
        static_cast<int>((pair.census_left(row, x) ^ pair.census_right(row, xr)).count());
    return static_cast<std::uint32_t>(cost_of_bits(pair, row, x, xr, hamming));
}

bool is_flat(const LevelPair& pair, int row, int col)
{
    if (pair.left(row, col) == kNodata) {
        return false;
    }
    int least = 255;
    int largest = 0;
    for (int i = -3; i <= 3; ++i) {
        for (int j = -3; j <= 3; ++j) {
            if (clamped(pair.left, row + i, col + j) != kNodata) {
                const int tone = clamped(pair.tone_left, row + i, col + j);
                least = std::min(least, tone);
                largest = std::max(largest, tone);
            }
        }
    }
    return largest - least < 7;
}

PixelCosts prior_of(const PixelCosts& coarse_sums, int paths)
{
    PixelCosts q(coarse_sums.range);
    const std::uint32_t least = coarse_sums.least();
    for (int d = q.range.min; d <= q.range.max; ++d) {
        const std::uint32_t above = coarse_sums.at(d) - least;
        q.at(d) = std::min(above / static_cast<std::uint32_t>(paths), 16u);
    }
    return q;
}

std::uint32_t prior_at(const PixelCosts& q, int d)
{
    const auto q_at = [&](int D) { return q.range.contains(D) ? q.at(D) : 16u; };
    const int half = tiling::floor_div(d, 2);
    return d % 2 == 0 ? q_at(half) : (q_at(half) + q_at(half + 1) + 1) >> 1;
}

} // namespace hsgm::reference
