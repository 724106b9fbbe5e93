#include "tests/reference/refine.h"

#include "matcher/reasons.h"

#include <algorithm>
#include <cstdlib>

namespace hsgm::reference {

namespace {

bool has_value(std::uint16_t reasons)
{
    return (reasons & matcher::kInvalidating) == 0;
}

} // namespace

std::uint16_t left_right_reason(const Image<std::uint32_t>& right_keys, int row, int x,
                                int winner, DisparityRange asked, int tolerance_px)
{
    const auto inside = [&](int col) { return col >= 0 && col < right_keys.cols(); };
    // Does the right pixel that lies at disparity d from us agree with d?
    const auto agrees = [&](int d) {
        const std::uint32_t key = right_keys(row, x - d);
        const int right_winner = static_cast<int>(key & 0xFFFFu) + asked.min;
        return key != kNoKey && std::abs(d - right_winner) <= tolerance_px;
    };
    if (!inside(x - winner)) {
        return matcher::kOutside;
    }
    if (agrees(winner)) {
        return 0;
    }
    for (int d = asked.min; d <= asked.max; ++d) {
        if (inside(x - d) && agrees(d)) {
            return matcher::kInconsistent;
        }
    }
    return matcher::kOccluded;
}

std::int32_t median_of_valid(const Image<std::int32_t>& disparity_q8,
                             const Image<std::uint16_t>& reasons, int row, int col, int side)
{
    const Rect image = tiling::rect_of(disparity_q8.size());
    std::vector<std::int32_t> values;
    for (int r = row - side / 2; r <= row + side / 2; ++r) {
        for (int c = col - side / 2; c <= col + side / 2; ++c) {
            if (image.contains(r, c) && has_value(reasons(r, c))) {
                values.push_back(disparity_q8(r, c));
            }
        }
    }
    std::sort(values.begin(), values.end());
    return values[(values.size() - 1) / 2];
}

RefineResult refine(const MatchResult& match, DisparityRange asked, const Options& options)
{
    const Size size = match.disparity_q8.size();
    RefineResult result;
    result.disparity_px = Image<float>(size, -32768.0F);
    result.confidence = Image<std::uint8_t>(size, 0);
    result.reasons = match.reasons;
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            if (options.left_right_px >= 0 && has_value(match.reasons(row, col))) {
                const std::uint16_t reason = left_right_reason(
                    match.right_keys, row, col, match.levels[0].winners(row, col), asked,
                    options.left_right_px);
                result.reasons(row, col) |= reason;
            }
        }
    }
    for (int row = 0; row < size.rows; ++row) {
        for (int col = 0; col < size.cols; ++col) {
            if (has_value(result.reasons(row, col))) {
                const std::int32_t fixed = median_of_valid(match.disparity_q8, result.reasons,
                                                           row, col, options.median);
                result.disparity_px(row, col) = static_cast<float>(fixed) / 256.0F;
                result.confidence(row, col) = match.confidence(row, col);
            }
        }
    }
    return result;
}

} // namespace hsgm::reference
