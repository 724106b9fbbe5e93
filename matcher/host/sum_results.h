#pragma once

#include "matcher/host/aligned.h"
#include "matcher/host/winner.h"

#include <cstdint>

namespace hsgm::matcher::host {

/// Of every pixel of a row: S(d-1) - S(d) and S(d+1) - S(d) at the winner d, S(d) and the
/// rival's sum (-1: none). Whole numbers below 2^16, as floats.
struct SumRelations {
    float* below;
    float* above;
    float* least;
    float* rival;
};

/// What level 0 gives for every pixel of a row of sums (docs/algorithm.md, section 5): the
/// winner with its sub-pixel part in 1/256 px (subpixel_q8) and the confidence
/// (confidence_of). The same integers, in vectors.
void sum_results(const SumsRow& row, const Winner* winners, int range_min,
                 Buffer<float>& workspace, std::int32_t* disparity_q8,
                 std::uint8_t* confidence);

} // namespace hsgm::matcher::host
