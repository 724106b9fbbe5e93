#pragma once

#include "pipeline/job.h"
#include "pipeline/stages/pixel_source.h"

#include <memory>

namespace hsgm::pipeline {

/// The images of a job as the matcher wants them: rectified ones as they are, raw ones drawn
/// into their epipolar frame on the way.
struct PairSources {
    std::unique_ptr<PixelSource> left;
    std::unique_ptr<PixelSource> right;
};

/// Opens them. `job` must outlive the result; of raw pairs it holds the geometry found.
PairSources open_sources(const Job& job);

} // namespace hsgm::pipeline
