#pragma once

#include <CLI/App.hpp>

namespace hsgm::pipeline {

/// Adds `hsgm match`: two rectified images in; disparity, confidence and reasons out.
CLI::App* add_match_command(CLI::App& app);

/// Adds `hsgm run`: the same and heights, from a configuration file.
CLI::App* add_run_command(CLI::App& app);

/// Adds `hsgm plan`: what a run would do and take, without doing it.
CLI::App* add_plan_command(CLI::App& app);

} // namespace hsgm::pipeline
