#pragma once

#include <array>
#include <cstdint>

namespace hsgm::matcher {

/// How far round a pixel its confidence looks.
constexpr int kConfidenceReach = 5;
/// Neighbours whose values differ by this at most, in 1/256 px, support a pixel...
constexpr int kCloseSupport_q8 = 64;
/// ... and once more if they differ by no more than this.
constexpr int kWideSupport_q8 = 384;
/// What one supporting neighbour is worth, beside the margins of 25 pixels of 0..255 each.
constexpr int kSupportWeight = 200;

/// Confidence by score / 256: the share of pixels within 1 px of the truth, in 1/255
/// (docs/algorithm.md, section 6, step 7; docs/benchmarks.md says what it was measured on).
/// Rises strictly, so that the score can be told from the confidence.
constexpr std::array<std::uint8_t, 50> kConfidenceOfScore{
    2,   4,   8,   12,  17,  23,  29,  36,  43,  50,  59,  68,  78,  88,  98,  109, 119,
    129, 138, 147, 156, 164, 172, 179, 185, 191, 197, 202, 207, 211, 215, 219, 222, 225,
    228, 230, 232, 234, 236, 238, 240, 242, 244, 246, 248, 250, 251, 252, 253, 254};

} // namespace hsgm::matcher
