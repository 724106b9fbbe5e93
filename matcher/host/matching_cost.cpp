#include "matcher/host/matching_cost.h"

#include "matcher/host/coarse_start.h"
#include "matcher/host/hamming.h"
#include "matcher/kernel.h"

#include <algorithm>

namespace hsgm::matcher::host {

namespace {

/// Whole vectors are read at the end of a row.
constexpr std::size_t kReadBeyond = 16;

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

void hmi_row(const LevelFeatures& features, const HmiTable& table, const CostVolume& volume,
             int row, const std::uint8_t* right, const std::uint8_t* valid, std::uint8_t half,
             std::uint8_t* costs)
{
    const int count = volume.range.count();
    for (int i = 0; i < volume.rect.cols; ++i, costs += volume.stride) {
        const int col = volume.rect.col + i;
        const int first = volume.rect.cols - 1 - i;
        const bool left_valid = is_valid(features.images->left.at(row, col));
        const std::uint8_t tone = features.left_tone.at(row, col);
        for (int j = 0; j < count; ++j) {
            costs[j] =
                left_valid && valid[first + j] != 0 ? table(tone, right[first + j]) : half;
        }
        std::fill(costs + count, costs + volume.stride, std::uint8_t{255});
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
    std::uint8_t* valid = workspace.right_valid.need(length + kReadBeyond);
    fill_reversed<std::uint8_t>(
        right, image_cols, 0,
        [&](int col) { return std::uint8_t(is_valid(features.images->right.at(row, col))); },
        valid);
    if (cost == Cost::hmi) {
        std::uint8_t* tone = workspace.right_tone.need(length);
        fill_reversed<std::uint8_t>(
            right, image_cols, 0, [&](int col) { return features.right_tone.at(row, col); },
            tone);
        hmi_row(features, *pair.hmi, volume, row, tone, valid, half, costs);
        return;
    }
    std::uint64_t* words = workspace.right_census.need(length + kReadBeyond);
    fill_reversed<std::uint64_t>(
        right, image_cols, 0, [&](int col) { return features.right_census.at(row, col); },
        words);
    std::uint8_t* left_valid = workspace.left_valid.need(std::size_t(volume.rect.cols));
    for (int i = 0; i < volume.rect.cols; ++i) {
        left_valid[i] = is_valid(features.images->left.at(row, volume.rect.col + i));
    }
    HammingRow words_row;
    words_row.left = &features.left_census.at(row, volume.rect.col);
    words_row.left_valid = left_valid;
    words_row.right = words;
    words_row.right_valid = valid;
    words_row.cols = volume.rect.cols;
    words_row.count = volume.range.count();
    words_row.stride = volume.stride;
    words_row.doubled = cost == Cost::census5x5;
    words_row.most = static_cast<std::uint8_t>(traits(cost).max);
    words_row.half = half;
    hamming_costs(words_row, costs);
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
