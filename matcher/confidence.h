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

/// Confidence by score / 512: the share of pixels within 1 px of the truth, in 1/255
/// (docs/algorithm.md, section 6, step 7; docs/benchmarks.md says what it was measured on).
/// Rises strictly, so that the score can be told from the confidence.
constexpr std::array<std::uint8_t, 25> kConfidenceOfScore{
    60,  71,  85,  102, 121, 140, 157, 174, 187, 199, 211, 222, 230,
    236, 241, 244, 247, 248, 249, 250, 251, 252, 253, 254, 255};

} // namespace hsgm::matcher
