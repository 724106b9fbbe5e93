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
    const auto right = features.images->right.pixels.pixels();
    right_has_gaps_ = std::find(right.begin(), right.end(), kNodataPixel) != right.end();
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
    find_winners(part, winners);
    const int r = row - result_.core.row;
    const int c = col - result_.core.col;
    sum_results(part, winners, sums.range.min, workspace.results,
                result_.disparity_q8.row(r) + c, result_.confidence.row(r) + c);
    add_reasons(winners, sums.range.min, row, col, cols);
    std::uint8_t* valid = workspace.valid.need(static_cast<std::size_t>(cols));
    const std::uint16_t* left = &features_.images->left.at(row, col);
    std::transform(left, left + cols, valid,
                   [](std::uint16_t pixel) { return std::uint8_t(is_valid(pixel)); });
    workspace.candidates.clear(cols, sums.stride);
    workspace.candidates.merge(part, valid);
    merge_right(part, sums.range.min, row, col, workspace.candidates);
}

void TileOutput::add_reasons(const Winner* winners, int range_min, int row, int col, int cols)
{
    const auto asked = pair_.shape.asked;
    const int right_cols = pair_.shape.right.cols;
    const std::uint16_t* left = &features_.images->left.at(row, col);
    const std::uint8_t* low_texture = &features_.low_texture.at(row, col);
    const tiling::Patch<std::uint16_t>& right = features_.images->right;
    std::uint16_t* out = result_.reasons.row(row - result_.core.row) + (col - result_.core.col);
    for (int i = 0; i < cols; ++i) {
        const int x = col + i;
        const int winner = range_min + winners[i].index;
        const int counterpart = x - winner;
        int reasons = low_texture[i] != 0 ? kLowTexture : 0;
        if (asked.count() > 1 && (winner == asked.min || winner == asked.max)) {
            reasons |= kRangeEnd;
        }
        if (x - asked.max > right_cols - 1 || x - asked.min < 0) {
            reasons |= kOutside;
        } else if (right_has_gaps_ && counterpart >= 0 && counterpart < right_cols &&
                   !is_valid(right.at(row, counterpart))) {
            reasons |= kNodataRight;
        }
        out[i] = static_cast<std::uint16_t>(is_valid(left[i]) ? reasons : kNodataLeft);
    }
}

void TileOutput::merge_right(const SumsRow& part, int range_min, int row, int col,
                             const RightCandidates& candidates)
{
    auto& target = result_.right_keys;
    const int last_col = col + part.cols - 1 - range_min;
    const int begin = std::max(0, last_col - (target.rect.col_end() - 1));
    const int end = std::min(part.cols + part.count - 1, last_col - target.rect.col + 1);
    if (begin >= end) {
        return;
    }
    const std::scoped_lock lock(row_locks_[static_cast<std::size_t>(row) % kLocks]);
    candidates.lower_keys(begin, end, range_min - pair_.shape.asked.min - (part.cols - 1),
                          &target.at(row, last_col - begin));
}

} // namespace hsgm::matcher::host
