#include "tests/reference/match.h"

#include "matcher/reasons.h"
#include "tests/reference/ensure.h"

#include <algorithm>
#include <cstdlib>

namespace hsgm::reference {

int sub_pixel_q8(const PixelCosts& sums, int winner)
{
    if (!sums.range.contains(winner - 1) || !sums.range.contains(winner + 1)) {
        return 256 * winner;
    }
    const std::uint32_t a = sums.at(winner - 1) - sums.at(winner);
    const std::uint32_t b = sums.at(winner + 1) - sums.at(winner);
    const std::uint32_t smaller = std::min(a, b);
    const std::uint32_t larger = std::max(a, b);
    if (larger == 0) {
        return 256 * winner;
    }
    const std::uint32_t x = 256 * smaller / larger;
    const int offset = 128 - static_cast<int>((x * x + 256 * x) >> 10);
    return a < b ? 256 * winner - std::min(offset, 127) : 256 * winner + offset;
}

std::uint8_t confidence_of(const PixelCosts& sums, int winner)
{
    const std::uint32_t best = sums.at(winner);
    std::uint32_t second = 0;
    bool has_second = false;
    for (int d = sums.range.min; d <= sums.range.max; ++d) {
        if (std::abs(d - winner) >= 2 && (!has_second || sums.at(d) < second)) {
            second = sums.at(d);
            has_second = true;
        }
    }
    if (!has_second) {
        return 255;
    }
    if (second == 0) {
        return 1;
    }
    return static_cast<std::uint8_t>(std::max(255 * (second - best) / second, 1u));
}

namespace {

Image<std::uint32_t> right_keys_of(const Level& level, DisparityRange asked)
{
    Image<std::uint32_t> keys(level.pair.right.size(), kNoKey);
    for (int row = 0; row < level.pair.left.rows(); ++row) {
        for (int x = 0; x < level.pair.left.cols(); ++x) {
            if (level.pair.left(row, x) == kNodata) {
                continue;
            }
            const PixelCosts& sums = level.sums(row, x);
            for (int d = sums.range.min; d <= sums.range.max; ++d) {
                if (x - d >= 0 && x - d < keys.cols()) {
                    const std::uint32_t key =
                        sums.at(d) << 16 | static_cast<std::uint32_t>(d - asked.min);
                    keys(row, x - d) = std::min(keys(row, x - d), key);
                }
            }
        }
    }
    return keys;
}

/// Steps 1 to 3 of section 6, and the reasons that keep the value.
/// A nodata pixel has no winner to speak of: it gets its reason and no other.
std::uint16_t first_reasons_of(const Level& level, DisparityRange asked, int row, int x)
{
    if (level.pair.left(row, x) == kNodata) {
        return matcher::kNodataLeft;
    }
    const Image<std::uint16_t>& right = level.pair.right;
    const auto inside = [&](int col) { return col >= 0 && col < right.cols(); };
    const int winner = level.winners(row, x);
    std::uint16_t reasons = 0;

    bool has_counterpart = false;
    for (int d = asked.min; d <= asked.max; ++d) {
        has_counterpart = has_counterpart || inside(x - d);
    }
    if (!has_counterpart) {
        reasons |= matcher::kOutside;
    } else if (inside(x - winner) && right(row, x - winner) == kNodata) {
        reasons |= matcher::kNodataRight;
    }

    if (is_flat(level.pair, row, x)) {
        reasons |= matcher::kLowTexture;
    }
    if (asked.count() > 1 && (winner == asked.min || winner == asked.max)) {
        reasons |= matcher::kRangeEnd;
    }
    return reasons;
}

} // namespace

MatchResult match(const Image<std::uint16_t>& left, const Image<std::uint16_t>& right,
                  DisparityRange asked, ToneEnds tone_left, ToneEnds tone_right,
                  const Options& options, const HmiCosts* hmi)
{
    const int levels = level_count(left.size(), right.size(), asked, options);
    const auto lefts = pyramid(left, levels);
    const auto rights = pyramid(right, levels);

    MatchResult result;
    result.levels.resize(static_cast<std::size_t>(levels));
    for (int k = levels - 1; k >= 0; --k) {
        const auto i = static_cast<std::size_t>(k);
        const bool coarsest = k == levels - 1;
        const bool whole = coarsest && options.mode != Mode::local;
        result.levels[i] = solve_level(
            make_level_pair(lefts[i], rights[i], tone_left, tone_right, options.cost, hmi),
            level_range(asked, k, levels), whole, options,
            coarsest ? nullptr : &result.levels[i + 1]);
    }

    const Level& level = result.levels[0];
    result.disparity_q8 = Image<std::int32_t>(left.size());
    result.confidence = Image<std::uint8_t>(left.size());
    result.reasons = Image<std::uint16_t>(left.size());
    result.right_keys = right_keys_of(level, asked);
    for (int row = 0; row < left.rows(); ++row) {
        for (int col = 0; col < left.cols(); ++col) {
            const PixelCosts& sums = level.sums(row, col);
            const int winner = level.winners(row, col);
            result.disparity_q8(row, col) = sub_pixel_q8(sums, winner);
            result.confidence(row, col) = confidence_of(sums, winner);
            result.reasons(row, col) = first_reasons_of(level, asked, row, col);
        }
    }
    return result;
}

} // namespace hsgm::reference
