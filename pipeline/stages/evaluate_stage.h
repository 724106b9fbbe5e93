#pragma once

#include "pipeline/evaluate/confidence_score.h"
#include "pipeline/evaluate/disparity_score.h"
#include "pipeline/evaluate/seam_score.h"
#include "pipeline/stages/disparity_rows.h"

#include <vector>

namespace hsgm::pipeline {

/// A disparity map against truth, files in, figures out; memory for a strip of rows. Throws
/// io::ConfigError for what cannot be asked, io::InputError for what cannot be read.
evaluate::DisparityScore score_disparity(const DisparityInputs& inputs,
                                         const std::vector<double>& thresholds_px);

/// What the map's confidence, `inputs.confidence`, is worth: errors above the threshold after
/// dropping the 0, 10, 20, 30 and 50 % least confident pixels. Throws the same.
evaluate::ConfidenceScore score_confidence(const DisparityInputs& inputs, double threshold_px);

/// The seam figure for each of several grids of cells, in one pass over the files; with a
/// truth, of its errors.
std::vector<evaluate::SeamScore> score_seams(const DisparityInputs& inputs,
                                             const std::vector<int>& cells_px);

} // namespace hsgm::pipeline
