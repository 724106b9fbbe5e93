#include "tests/reference/cost.h"

#include "tests/reference/ensure.h"

#include <algorithm>

namespace hsgm::reference {

std::uint32_t PixelCosts::least() const
{
    return *std::min_element(values.begin(), values.end());
}

CostRule rule(Cost cost)
{
    switch (cost) {
    case Cost::census5x5:
        return {5, 5, 48};
    case Cost::census7x7:
        return {7, 7, 48};
    case Cost::census9x7: // 7 rows, 9 columns
        return {7, 9, 59};
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

namespace {

Image<CensusBits> census_of(const Image<std::uint16_t>& image, CostRule window)
{
    Image<CensusBits> result(image.size());
    for (int row = 0; row < image.rows(); ++row) {
        for (int col = 0; col < image.cols(); ++col) {
            result(row, col) = census_at(image, row, col, window.rows, window.cols);
        }
    }
    return result;
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
    } else {
        pair.census_left = census_of(left, rule(cost));
        pair.census_right = census_of(right, rule(cost));
    }
    return pair;
}

std::uint32_t matching_cost(const LevelPair& pair, int row, int x, int d)
{
    const int xr = x - d;
    const bool inside = xr >= 0 && xr < pair.right.cols();
    if (pair.left(row, x) == kNodata || !inside || pair.right(row, xr) == kNodata) {
        return rule(pair.cost).max / 2;
    }
    if (pair.cost == Cost::hmi) {
        return (*pair.hmi)(pair.tone_left(row, x), pair.tone_right(row, xr));
    }
    const auto hamming = static_cast<std::uint32_t>(
        (pair.census_left(row, x) ^ pair.census_right(row, xr)).count());
    switch (pair.cost) {
    case Cost::census5x5:
        return 2 * hamming;
    case Cost::census9x7:
        return std::min(hamming, 59u);
    default:
        return hamming;
    }
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
