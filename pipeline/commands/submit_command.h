#pragma once

#include <CLI/App.hpp>

namespace hsgm::pipeline {

/// Adds `hsgm submit CONFIG --engine slurm`: a run as jobs of a cluster.
CLI::App* add_submit_command(CLI::App& app);

} // namespace hsgm::pipeline
