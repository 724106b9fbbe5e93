#include "matcher/host/tile_output.h"

#include "matcher/kernel.h"
#include "matcher/reasons.h"

#include <algorithm>

namespace hsgm::matcher::host {

namespace {

constexpr std::size_t kLocks = 64;
constexpr int kPartCols = 1024;

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

void TileOutput::add(const BlockSums& sums, OutputWorkspace& workspace)
{
    add_rows(sums, sums.core.row, sums.core.row_end(), workspace);
}

void TileOutput::add_rows(const BlockSums& sums, int begin, int end, OutputWorkspace& workspace)
{
    const auto part = intersect(sums.core, result_.core);
    for (int row = std::max(begin, part.row); row < std::min(end, part.row_end()); ++row) {
        // Parts short enough for the 16-bit pixel numbers of the right view's candidates.
        for (int col = part.col; col < part.col_end(); col += kPartCols) {
            add_part(sums, row, col, std::min(kPartCols, part.col_end() - col), workspace);
        }
    }
}

void TileOutput::add_part(const BlockSums& sums, int row, int col, int cols,
                          OutputWorkspace& workspace)
{
    const SumsRow part{sums.at(row, col), cols, sums.stride, sums.range.count()};
    Winner* winners = workspace.winners.need(static_cast<std::size_t>(cols));
    std::uint8_t* valid = workspace.valid.need(static_cast<std::size_t>(cols));
    find_winners(part, winners);
    const std::uint16_t* left = &features_.images->left.at(row, col);
    for (int i = 0; i < cols; ++i) {
        valid[i] = static_cast<std::uint8_t>(is_valid(left[i]));
        add_pixel(part, i, winners[i], sums.range.min, row, col + i);
    }
    workspace.candidates.clear(cols, sums.stride);
    workspace.candidates.merge(part, valid);
    merge_right(part, sums.range.min, row, col, workspace.candidates);
}

void TileOutput::add_pixel(const SumsRow& part, int i, const Winner& winner, int range_min,
                           int row, int col)
{
    const int disparity = range_min + winner.index;
    const bool inner = winner.index > 0 && winner.index + 1 < part.count;
    const std::uint16_t* s = part.at(i);
    const int r = row - result_.core.row;
    const int c = col - result_.core.col;
    result_.disparity_q8(r, c) =
        inner ? subpixel_q8(disparity, sum_at(s, part.stride, winner.index - 1), winner.sum,
                            sum_at(s, part.stride, winner.index + 1))
              : disparity * 256;
    result_.confidence(r, c) = static_cast<std::uint8_t>(
        winner.rival < 0 ? 255 : confidence_of(winner.sum, winner.rival));
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

void TileOutput::merge_right(const SumsRow& part, int range_min, int row, int col,
                             const RightCandidates& candidates)
{
    auto& target = result_.right_keys;
    const auto asked_first = static_cast<std::uint32_t>(range_min - pair_.shape.asked.min);
    const int last_col = col + part.cols - 1 - range_min;
    const int begin = std::max(0, last_col - (target.rect.col_end() - 1));
    const int end = std::min(part.cols + part.count - 1, last_col - target.rect.col + 1);
    if (begin >= end) {
        return;
    }
    const std::scoped_lock lock(row_locks_[static_cast<std::size_t>(row) % kLocks]);
    std::uint32_t* keys = &target.at(row, last_col - begin);
    for (int j = begin; j < end; ++j, --keys) {
        const std::uint16_t pixel = candidates.pixel(j);
        if (pixel != RightCandidates::kNobody) {
            const auto index = static_cast<std::uint32_t>(j - (part.cols - 1 - pixel));
            *keys = std::min(*keys, std::uint32_t{candidates.sum(j)} << 16 |
                                        (asked_first + index));
        }
    }
}

} // namespace hsgm::matcher::host
