#include "matcher/host/tile_output.h"

#include "matcher/host/winner.h"
#include "matcher/kernel.h"
#include "matcher/reasons.h"

#include <algorithm>

namespace hsgm::matcher::host {

namespace {

constexpr std::size_t kLocks = 64;

} // namespace

TileOutput::TileOutput(const tiling::Rect& core, const LevelFeatures& features,
                       const PairTraits& pair)
    : features_(features), pair_(pair), row_locks_(kLocks)
{
    result_.core = core;
    result_.disparity_q8 = tiling::Image<std::int32_t>(core.size());
    result_.confidence = tiling::Image<std::uint8_t>(core.size());
    result_.reasons = tiling::Image<std::uint16_t>(core.size());
    const auto seen = intersect(right_reach(core, pair.shape.asked), rect_of(pair.shape.right));
    result_.right_keys = tiling::Patch<std::uint32_t>(seen, kNoKey);
}

void TileOutput::add(const BlockSums& sums, Buffer<std::uint32_t>& keys)
{
    add_rows(sums, sums.core.row, sums.core.row_end(), keys);
}

void TileOutput::add_rows(const BlockSums& sums, int begin, int end,
                          Buffer<std::uint32_t>& keys)
{
    const auto part = intersect(sums.core, result_.core);
    const auto first = static_cast<std::uint32_t>(sums.range.min - pair_.shape.asked.min);
    // Keys of one row in the order of rising disparity: entry j is right column last_col - j.
    const int count = part.cols + sums.range.count() - 1;
    const int last_col = part.col_end() - 1 - sums.range.min;
    for (int row = std::max(begin, part.row); row < std::min(end, part.row_end()); ++row) {
        std::uint32_t* row_keys = keys.need(static_cast<std::size_t>(count));
        std::fill_n(row_keys, count, kNoKey);
        for (int col = part.col; col < part.col_end(); ++col) {
            add_pixel(sums, row, col);
            if (is_valid(features_.images->left.at(row, col))) {
                merge_keys(sums.at(row, col), first, row_keys + (part.col_end() - 1 - col));
            }
        }
        merge_row(row, row_keys, last_col, count);
    }
}

void TileOutput::add_pixel(const BlockSums& sums, int row, int col)
{
    const auto s = sums.at(row, col);
    const Winner winner = find_winner(s);
    const int disparity = sums.range.min + winner.index;
    const auto i = static_cast<std::size_t>(winner.index);
    const bool inner = i > 0 && i + 1 < s.size();
    const int r = row - result_.core.row;
    const int c = col - result_.core.col;
    result_.disparity_q8(r, c) =
        inner ? subpixel_q8(disparity, s[i - 1], s[i], s[i + 1]) : disparity * 256;
    const int rival = rival_sum(s, winner.index);
    result_.confidence(r, c) =
        static_cast<std::uint8_t>(rival < 0 ? 255 : confidence_of(winner.sum, rival));
    result_.reasons(r, c) = reasons_of(row, col, disparity);
}

std::uint16_t TileOutput::reasons_of(int row, int col, int winner) const
{
    const auto asked = pair_.shape.asked;
    const int right_cols = pair_.shape.right.cols;
    if (!is_valid(features_.images->left.at(row, col))) {
        return kNodataLeft;
    }
    int reasons = 0;
    const int counterpart = col - winner;
    if (col - asked.max > right_cols - 1 || col - asked.min < 0) {
        reasons |= kOutside;
    } else if (counterpart >= 0 && counterpart < right_cols &&
               !is_valid(features_.images->right.at(row, counterpart))) {
        reasons |= kNodataRight;
    }
    if (features_.low_texture.at(row, col) != 0) {
        reasons |= kLowTexture;
    }
    if (asked.count() > 1 && (winner == asked.min || winner == asked.max)) {
        reasons |= kRangeEnd;
    }
    return static_cast<std::uint16_t>(reasons);
}

void TileOutput::merge_row(int row, const std::uint32_t* keys, int last_col, int count)
{
    auto& target = result_.right_keys;
    const std::scoped_lock lock(row_locks_[static_cast<std::size_t>(row) % kLocks]);
    const int begin = std::max(0, last_col - (target.rect.col_end() - 1));
    const int end = std::min(count, last_col - target.rect.col + 1);
    for (int j = begin; j < end; ++j) {
        std::uint32_t& key = target.at(row, last_col - j);
        key = std::min(key, keys[j]);
    }
}

} // namespace hsgm::matcher::host
