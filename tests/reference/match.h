#pragma once

#include "tests/reference/level.h"

#include <vector>

namespace hsgm::reference {

constexpr std::uint32_t kNoKey = 0xFFFFFFFFu;

/// The first pass: every level in full, and what level 0 gives.
struct MatchResult {
    std::vector<Level> levels; ///< level 0 first
    Image<std::int32_t> disparity_q8;
    Image<std::uint8_t> confidence; ///< 1..255, also where there will be no value
    Image<std::uint16_t> reasons;   ///< of section 6: those that need no right view
    Image<std::uint32_t> right_keys;
};

/// Sections 2 to 5, and steps 1 to 3 of section 6. `hmi` for cost `hmi` only, else null.
MatchResult match(const Image<std::uint16_t>& left, const Image<std::uint16_t>& right,
                  DisparityRange asked, ToneEnds tone_left, ToneEnds tone_right,
                  const Options& options, const HmiCosts* hmi = nullptr);

/// Section 5 for one pixel with sums S and winner d*.
int sub_pixel_q8(const PixelCosts& sums, int winner);
std::uint8_t confidence_of(const PixelCosts& sums, int winner);

} // namespace hsgm::reference
