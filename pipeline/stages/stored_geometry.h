#pragma once

#include "pipeline/geometry/pair_geometry.h"
#include "pipeline/job.h"
#include "pipeline/stages/run_layout.h"
#include "pipeline/stages/run_manner.h"

#include <string>
#include <utility>

namespace hsgm::pipeline {

/// Reads a geometry that a run kept, for the images of `job`. Throws InputError where it cannot
/// be read or was found with other models than these images have.
geometry::PairGeometry read_geometry(const std::string& path, const Job& job);

/// What an earlier run added to the models of a job's images, left and right, whichever was
/// which then. Throws InputError where its geometry cannot be read or is not of both images.
std::pair<geometry::ImageCorrection, geometry::ImageCorrection>
read_corrections(const std::string& path, const Job& job);

/// Lets a raw pair's job go on with the geometry that the run in this folder found, where it
/// goes on with such a run: libraries of another machine might find one that differs in the
/// last digits. Before planning.
void take_kept_geometry(Job& job, const RunManner& manner);

/// Keeps what planning found for the other processes of the run; does nothing for rectified
/// pairs. Under the lock of the coarse stage. Throws StorageError where another process kept
/// another geometry meanwhile.
void keep_geometry(const Job& job, const RunLayout& layout);

/// Puts it beside the results.
void publish_geometry(const Job& job, const RunLayout& layout);

} // namespace hsgm::pipeline
