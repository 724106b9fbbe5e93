#pragma once

#include "tests/reference/fraction.h"
#include "tests/reference/match.h"

namespace hsgm::reference {

/// The final outputs.
struct RefineResult {
    Image<float> disparity_px;      ///< -32768 where there is no value
    Image<std::uint8_t> confidence; ///< 0 where there is no value
    Image<std::uint16_t> reasons;
};

/// Step 4 of section 6 for a pixel whose winner is `winner`: 0 or the reason that takes
/// its value. `right_keys` are those of the whole image.
std::uint16_t left_right_reason(const Image<std::uint32_t>& right_keys, int row, int x,
                                int winner, DisparityRange asked, int tolerance_px);

/// Step 5: how many pixels the connected segment of each pixel has; 0 without a value.
Image<int> segment_sizes(const Surface& surface, int range_q8);

/// Step 9 for a pixel: the median over the pixels of its neighbourhood that have a value.
/// At least one has.
std::int32_t median_of_valid(const Image<std::int32_t>& disparity_q8,
                             const Image<std::uint16_t>& reasons, int row, int col, int side);

/// Step 10 for a pixel that has a value.
std::int32_t mean_of_near(const Surface& surface, int row, int col, int side);

/// What step 11 finds in the eight directions of a pixel, sorted.
std::vector<std::int32_t> values_around(const Surface& surface, int row, int col, int reach_px);

/// Section 6, steps 4 to 11, and the outputs.
RefineResult refine(const MatchResult& match, DisparityRange asked, const Options& options);

} // namespace hsgm::reference
