#pragma once

#include "pipeline/job.h"
#include "pipeline/stages/dsm_stage.h"

namespace hsgm::pipeline {

/// Finds the geometry of a job's raw pair, or reads the stored one, and keeps it in the job
/// with the range of disparities. Throws what `find_pair_geometry` throws, and InputError for a
/// stored geometry that cannot be read or is of other images.
void plan_satellite(Job& job);

/// How the points of a planned pair become cells, and what their rasters say of themselves.
DsmOptions dsm_options(const Job& job);

/// A raw pair's finished match, as its outputs have it; the job's geometry must outlive it.
MatchedPair matched_pair(const Job& job);

/// Heights and DSM of a raw pair from its finished disparities and confidences.
DsmSummary write_satellite_heights(const Job& job);

/// What the geometry and the reference DEM of a raw pair hold as long as the run lasts.
std::int64_t held_bytes(const Job& job);

/// What heights, DSM and its shading take at most with this many threads.
std::int64_t satellite_bytes(const Job& job, int threads);

/// What the DSM and its sidecars take at most on the disk, uncompressed.
std::int64_t satellite_output_bytes(const Job& job);

} // namespace hsgm::pipeline
