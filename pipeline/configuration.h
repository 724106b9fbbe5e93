#pragma once

#include "io/config.h"
#include "pipeline/job.h"

#include <string>

namespace hsgm::pipeline {

/// A configuration read to the end: the job, and the complete file with all defaults.
struct Configuration {
    Job job;
    std::string used_yaml;
    std::filesystem::path folder; ///< of the results
};

/// Reads the configuration of `hsgm run` (docs/configuration.md). Unknown keys, wrong types
/// and values that are not allowed throw ConfigError naming file, line, key and what is; a
/// device that this build does not have, BudgetError. Paths of the outputs lie in
/// `output.folder`.
Configuration read_configuration(io::ConfigDocument& document);

/// Reads only `matcher` and `run`, for `hsgm match`: images, range and output come from the
/// command line.
Job read_knobs(io::ConfigDocument& document);

} // namespace hsgm::pipeline
