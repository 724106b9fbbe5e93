#pragma once

#include <CLI/App.hpp>

namespace hsgm::pipeline {

/// Adds `hsgm bench`: speed and memory of the whole match beside OpenCV's. It runs while `app`
/// parses; io::ConfigError, io::InputError and BudgetError come out of it.
CLI::App* add_bench_command(CLI::App& app);

} // namespace hsgm::pipeline
