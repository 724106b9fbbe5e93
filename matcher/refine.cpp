#include "matcher/refine.h"

#include "matcher/kernel.h"
#include "matcher/matcher.h"
#include "matcher/median.h"
#include "matcher/reasons.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace hsgm::matcher {

namespace {

using tiling::Patch;
using tiling::Rect;

class LeftRightCheck {
public:
    LeftRightCheck(const RefineInput& input, const PairShape& shape, int tolerance_px)
        : input_(input), shape_(shape), tolerance_(tolerance_px)
    {
    }

    // The reason the check gives the pixel; 0 if both views agree.
    std::uint16_t reason(int row, int col) const
    {
        const int winner = winner_of(input_.disparity_q8.at(row, col));
        const int counterpart = col - winner;
        if (counterpart < 0 || counterpart >= shape_.right.cols) {
            return kOutside;
        }
        if (agrees(row, counterpart, winner)) {
            return 0;
        }
        return matches_elsewhere(row, col) ? kInconsistent : kOccluded;
    }

private:
    bool agrees(int row, int right_col, int disparity) const
    {
        const std::uint32_t key = input_.right_keys.at(row, right_col);
        if (key == kNoKey) {
            return false;
        }
        const int right_winner = static_cast<int>(key & 0xFFFFU) + shape_.asked.min;
        return std::abs(right_winner - disparity) <= tolerance_;
    }

    // Whether the pixel's epipolar line meets the right view's surface anywhere: then it is
    // a mismatch, otherwise it is occluded (Hirschmueller 2008, section 2.4).
    bool matches_elsewhere(int row, int col) const
    {
        const int first = std::max(0, col - shape_.asked.max);
        const int last = std::min(shape_.right.cols - 1, col - shape_.asked.min);
        if (first > last) {
            return false;
        }
        // No branch inside, so that the compiler compares whole vectors. kNoKey stands for a
        // disparity of asked.min + 65535, which agrees with none.
        const std::uint32_t* keys = &input_.right_keys.at(row, first);
        const auto width = static_cast<unsigned>(2 * tolerance_);
        unsigned found = 0;
        for (int i = 0; i <= last - first; ++i) {
            const int right_winner = static_cast<int>(keys[i] & 0xFFFFU) + shape_.asked.min;
            const int difference = right_winner - (col - first - i);
            found |= static_cast<unsigned>(difference + tolerance_) <= width ? 1U : 0U;
        }
        return found != 0;
    }

    const RefineInput& input_;
    const PairShape& shape_;
    int tolerance_;
};

Patch<std::uint16_t> all_reasons(const RefineInput& input, const PairShape& shape,
                                 const Options& options)
{
    Patch<std::uint16_t> reasons = input.reasons;
    if (options.left_right_px < 0) {
        return reasons;
    }
    const LeftRightCheck check(input, shape, options.left_right_px);
    const Rect& part = reasons.rect;
    for (int row = part.row; row < part.row_end(); ++row) {
        for (int col = part.col; col < part.col_end(); ++col) {
            std::uint16_t& bits = reasons.at(row, col);
            if ((bits & kInvalidating) == 0) {
                bits = static_cast<std::uint16_t>(bits | check.reason(row, col));
            }
        }
    }
    return reasons;
}

// Median over the pixels round (row, col) that have a value; the lower one of two middles.
std::int32_t median_at(const Patch<std::int32_t>& disparity,
                       const Patch<std::uint16_t>& reasons, int row, int col, int radius)
{
    std::array<std::int32_t, 25> values{};
    const Rect around = intersect(expand(Rect{row, col, 1, 1}, radius), disparity.rect);
    std::ptrdiff_t count = 0;
    for (int r = around.row; r < around.row_end(); ++r) {
        for (int c = around.col; c < around.col_end(); ++c) {
            if ((reasons.at(r, c) & kInvalidating) == 0) {
                values[static_cast<std::size_t>(count++)] = disparity.at(r, c);
            }
        }
    }
    if (count == 9) {
        return median_of_nine<std::int32_t>({values[0], values[1], values[2], values[3],
                                             values[4], values[5], values[6], values[7],
                                             values[8]});
    }
    const auto middle = values.begin() + (count - 1) / 2;
    std::nth_element(values.begin(), middle, values.begin() + count);
    return *middle;
}

} // namespace

int refine_margin_px(const Options& options)
{
    return options.median / 2;
}

Rect keys_of(const Rect& grown, const PairShape& shape)
{
    return intersect(right_reach(grown, shape.asked), rect_of(shape.right));
}

Refined refine(const Rect& core, const RefineInput& input, const PairShape& shape,
               const Options& options)
{
    const Patch<std::uint16_t> reasons = all_reasons(input, shape, options);
    Refined result{tiling::Image<float>(core.size(), kNodataDisparity),
                   tiling::Image<std::uint8_t>(core.size()),
                   tiling::Image<std::uint16_t>(core.size())};
    const int radius = refine_margin_px(options);
    for (int r = 0; r < core.rows; ++r) {
        for (int c = 0; c < core.cols; ++c) {
            const int row = core.row + r;
            const int col = core.col + c;
            result.reasons(r, c) = reasons.at(row, col);
            if ((reasons.at(row, col) & kInvalidating) != 0) {
                continue;
            }
            const std::int32_t value =
                radius == 0 ? input.disparity_q8.at(row, col)
                            : median_at(input.disparity_q8, reasons, row, col, radius);
            result.disparity_px(r, c) = static_cast<float>(value) / 256.0F;
            result.confidence(r, c) = input.confidence.at(row, col);
        }
    }
    return result;
}

} // namespace hsgm::matcher
