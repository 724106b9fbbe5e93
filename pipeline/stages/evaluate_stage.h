#pragma once

#include "pipeline/evaluate/disparity_score.h"
#include "pipeline/evaluate/seam_score.h"
#include "pipeline/stages/disparity_rows.h"

#include <vector>

namespace hsgm::pipeline {

/// A disparity map against truth, files in, figures out; memory for a strip of rows. Throws
/// io::ConfigError for what cannot be asked, io::InputError for what cannot be read.
evaluate::DisparityScore score_disparity(const DisparityInputs& inputs,
                                         const std::vector<double>& thresholds_px);

/// The seam figure for each of several grids of cells, in one pass over the files; with a
/// truth, of its errors.
std::vector<evaluate::SeamScore> score_seams(const DisparityInputs& inputs,
                                             const std::vector<int>& cells_px);

} // namespace hsgm::pipeline
