#pragma once

#include "pipeline/evaluate/coregistration.h"
#include "pipeline/job.h"
#include "pipeline/stages/cell_rasters.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// A pair whose run is finished.
struct FinishedPair {
    std::string name;
    Job job; ///< as it was run: with its geometry and its outputs
};

/// How a pair's surface was moved before it was fused.
struct PairShift {
    std::string name;
    evaluate::SurfaceShift shift_m; ///< of its surface against the mean of all; taken out
    bool horizontal = true;         ///< false: the ground showed a shift in height alone
    double nmad_m = 0;              ///< of what it differs by from the one it was laid on
};

struct FuseSummary {
    DsmSummary dsm;
    std::vector<PairShift> pairs;
};

/// Makes one DSM of several pairs' points. Their surfaces lie beside each other by what a pair
/// cannot know of its pointing: each is laid on the first one by Nuth's and Kaeaeb's shift (one
/// that does not meet the first, on one laid before), and all on their mean. Then every pair's
/// points become cells of one grid, and these are fused (`dsm::fuse`). The same bytes whatever
/// the number of threads; give the pairs in a fixed order. On the threads of the arena it is
/// called in. Throws InputError where a pair meets no other one, ConfigError where maps or
/// cells differ or are in degrees.
FuseSummary fuse_pairs(const std::vector<FinishedPair>& pairs, const OutputPaths& outputs);

/// What that takes at most with this many threads.
std::int64_t fuse_bytes(const std::vector<FinishedPair>& pairs, int threads);

} // namespace hsgm::pipeline
