#pragma once

#include "pipeline/job.h"

namespace hsgm::pipeline {

/// Finds out what would spoil the outputs before hours of work do, and writes nothing: an
/// output that is also an input, or a folder, or creation options that GDAL refuses. Throws
/// ConfigError or StorageError.
void check_outputs(const Job& job);

} // namespace hsgm::pipeline
