#pragma once

#include <CLI/App.hpp>

namespace hsgm::pipeline {

/// Adds `hsgm evaluate disparity` and `hsgm evaluate seams`, and returns `evaluate`, so that
/// others can add what else there is to evaluate. The figures go to standard output. The
/// commands run while `app` parses; io::ConfigError and io::InputError come out of it.
CLI::App* add_evaluate_command(CLI::App& app);

} // namespace hsgm::pipeline
