#pragma once

#include "tests/reference/cost.h"

#include <cstdint>
#include <vector>

namespace hsgm::reference {

/// joint(tone of the left pixel, tone of the right pixel) = how often matched.
using JointCounts = Image<std::uint64_t>;

/// The 7-tap Gaussian of section 7 along a line, replicated at its ends.
std::vector<double> smoothed(const std::vector<double>& line);
/// The same along i (the rows' index) first, then along k.
Image<double> smoothed(const Image<double>& plane);

/// The table of a histogram.
HmiCosts hmi_table(const JointCounts& joint);

/// Counts the tones that `winners` brings together: valid pixels with a valid counterpart.
JointCounts joint_counts(const LevelPair& pair, const Image<int>& winners);

/// The level that the table is made from: the coarsest of hsgm with levels auto.
int hmi_level_count(Size left, Size right, DisparityRange asked);

/// The whole of section 7, from full-resolution images.
HmiCosts solve_hmi(const Image<std::uint16_t>& left, const Image<std::uint16_t>& right,
                   DisparityRange asked, ToneEnds tone_left, ToneEnds tone_right,
                   const Options& options);

} // namespace hsgm::reference
