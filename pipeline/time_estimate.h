#pragma once

#include "pipeline/stages/part_plan.h"

namespace hsgm::pipeline {

/// How long a run may take on this machine, with its processor alone: a guess, which depends
/// on what else the machine does and on what the images show. Nothing is decided by it.
///
/// What computing takes is measured on the spot, in a fraction of a second, by matching a small
/// made scene with the options of the job on one thread; what reading and writing takes follows
/// from rates that docs/operations.md states.
struct TimeEstimate {
    double match_ns_per_px = 0;  ///< measured: one thread, windows of all levels, no tiles
    double refine_ns_per_px = 0; ///< measured: one thread, the second pass
    double prepare_s = 0;        ///< reading, resampling, pyramids
    double coarse_s = 0;         ///< the coarsest level, by every process that matches tiles
    double tiles_s = 0;          ///< all tiles, on the threads of the plan
    double assemble_s = 0;       ///< second pass, rasters, DSM, shading, report

    /// All stages in one process.
    double all_s() const { return prepare_s + coarse_s + tiles_s + assemble_s; }
    /// One part of a run that is shared out.
    double part_s(const PlannedPart& part, const matcher::PairShape& shape) const;
    /// From the beginning to the end where every shard has a machine like this one.
    double side_by_side_s(const std::vector<PlannedPart>& parts,
                          const matcher::PairShape& shape) const;
};

/// Measures, and estimates.
TimeEstimate estimate_time(const PlannedJob& planned);

/// "40 s", "12 min", "3.4 h": as exact as such a guess is.
std::string rough_time(double seconds);

} // namespace hsgm::pipeline
