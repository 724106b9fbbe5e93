#pragma once

#include "pipeline/stages/cell_rasters.h"

#include <cstdint>

namespace hsgm::pipeline {

/// Heights in the frame, then the DSM on the map. Both walk fixed pieces in a fixed order, on
/// the threads of the arena it is called in: the same bytes for whatever tiles the match had.
/// Rasters get their names when all of them are whole; the DSM and its reasons are
/// cloud-optimized GeoTIFFs. Throws InputError where not a single pixel has a disparity, or
/// none of them lies in the region asked for.
DsmSummary write_dsm(const MatchedPair& pair, const DsmOptions& options, const DsmPaths& paths);

/// Walks the pieces of a finished match only for what they hold.
std::vector<PieceSurvey> survey_pair(const MatchedPair& pair);

/// The grid over all that `points` cover of the region, if there is one. Throws InputError
/// where they do not meet; `where` names the points in its sentence.
dsm::DsmGrid grid_over(dsm::Bounds points, const CellManner& manner, const std::string& where);

/// Upper bound of the memory that it takes with this many threads.
std::int64_t dsm_bytes(double gsd_m, double cell_m, int threads);

} // namespace hsgm::pipeline
