#include "matcher/host/matching_cost.h"

#include "matcher/host/coarse_start.h"
#include "matcher/kernel.h"

#include <algorithm>
#include <bit>

namespace hsgm::matcher::host {

namespace {

// The right row in the order of rising disparity: entry j belongs to right column
// last_col - j, so that pixel x with disparity volume.range.min + i reads entry
// (volume's last column - x) + i.
struct RightRow {
    int last_col;
    int count;
};

RightRow right_row(const CostVolume& volume)
{
    return {volume.rect.col_end() - 1 - volume.range.min,
            volume.rect.cols + volume.range.count() - 1};
}

template <typename Value, typename Read>
void fill_reversed(RightRow right, int image_cols, Value outside, Read read, Value* out)
{
    for (int j = 0; j < right.count; ++j) {
        const int col = right.last_col - j;
        out[j] = col >= 0 && col < image_cols ? read(col) : outside;
    }
}

// One pixel's costs from the right row's entries: `cost_of(entry)` where there is a valid
// counterpart, half the maximum elsewhere, 255 in the padding.
template <typename Entry, typename CostOf>
void pixel_costs(const Entry* right, const std::uint8_t* valid, int count, int stride,
                 std::uint8_t half, CostOf cost_of, std::uint8_t* costs)
{
    for (int i = 0; i < count; ++i) {
        costs[i] = valid[i] != 0 ? cost_of(right[i]) : half;
    }
    std::fill(costs + count, costs + stride, std::uint8_t{255});
}

template <typename Entry, typename MakeCost>
void cost_row(const LevelFeatures& features, const CostVolume& volume, int row,
              std::uint8_t half, const Entry* right, const std::uint8_t* valid,
              MakeCost make_cost, std::uint8_t* costs)
{
    const int count = volume.range.count();
    for (int i = 0; i < volume.rect.cols; ++i, costs += volume.stride) {
        const int col = volume.rect.col + i;
        if (!is_valid(features.images->left.at(row, col))) {
            std::fill_n(costs, count, half);
            std::fill(costs + count, costs + volume.stride, std::uint8_t{255});
            continue;
        }
        const int first = volume.rect.cols - 1 - i;
        pixel_costs(right + first, valid + first, count, volume.stride, half, make_cost(col),
                    costs);
    }
}

} // namespace

void matching_cost_row(const LevelFeatures& features, const PairTraits& pair, Cost cost,
                       const CostVolume& volume, int row, std::uint8_t* costs,
                       CostWorkspace& workspace)
{
    const RightRow right = right_row(volume);
    const auto length = static_cast<std::size_t>(right.count);
    const int image_cols = features.right_size.cols;
    const auto half = static_cast<std::uint8_t>(traits(cost).max / 2);
    std::uint8_t* valid = workspace.right_valid.need(length);
    fill_reversed<std::uint8_t>(
        right, image_cols, 0,
        [&](int col) { return std::uint8_t(is_valid(features.images->right.at(row, col))); },
        valid);
    if (cost == Cost::hmi) {
        std::uint8_t* tone = workspace.right_tone.need(length);
        fill_reversed<std::uint8_t>(
            right, image_cols, 0, [&](int col) { return features.right_tone.at(row, col); },
            tone);
        cost_row(
            features, volume, row, half, tone, valid,
            [&](int col) {
                const std::uint8_t* table =
                    pair.hmi->cost.data() + 256u * features.left_tone.at(row, col);
                return [table](std::uint8_t t) { return table[t]; };
            },
            costs);
        return;
    }
    std::uint64_t* words = workspace.right_census.need(length);
    fill_reversed<std::uint64_t>(
        right, image_cols, 0, [&](int col) { return features.right_census.at(row, col); },
        words);
    const auto census_rows = [&](auto scale) {
        cost_row(
            features, volume, row, half, words, valid,
            [&](int col) {
                const std::uint64_t left = features.left_census.at(row, col);
                return [left, scale](std::uint64_t word) {
                    return static_cast<std::uint8_t>(scale(std::popcount(left ^ word)));
                };
            },
            costs);
    };
    switch (cost) {
    case Cost::census5x5:
        census_rows([](int bits) { return 2 * bits; });
        break;
    case Cost::census9x7:
        census_rows([](int bits) { return std::min(bits, 59); });
        break;
    default:
        census_rows([](int bits) { return bits; });
    }
}

template <typename L>
void add_prior_row(const LevelFeatures& features, const LevelResult<L>& coarser,
                   const CostVolume& volume, int row, std::uint8_t* costs,
                   CostWorkspace& workspace)
{
    const int count = volume.range.count();
    std::uint8_t* prior = workspace.prior.need(2 * std::size_t(count) + 16);
    std::uint8_t* scratch = prior + count + 4;
    for (int i = 0; i < volume.rect.cols; ++i, costs += volume.stride) {
        const int col = volume.rect.col + i;
        if (features.low_texture.at(row, col) == 0) {
            continue;
        }
        const auto& block = coarser.block_at(row / 2, col / 2);
        spread_disparities(block.prior_at(row / 2, col / 2), block.range, volume.range,
                           std::uint8_t{kPriorCap}, scratch, prior);
        for (int d = 0; d < count; ++d) {
            costs[d] = static_cast<std::uint8_t>(costs[d] + (prior[d] >> 2));
        }
    }
}

template void add_prior_row(const LevelFeatures&, const LevelResult<std::uint8_t>&,
                            const CostVolume&, int, std::uint8_t*, CostWorkspace&);
template void add_prior_row(const LevelFeatures&, const LevelResult<std::uint16_t>&,
                            const CostVolume&, int, std::uint8_t*, CostWorkspace&);

} // namespace hsgm::matcher::host
