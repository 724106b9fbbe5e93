#pragma once

#include <CLI/App.hpp>

namespace hsgm::pipeline {

/// Adds `hsgm synth` and returns it. It runs while `app` parses; io::ConfigError and
/// io::StorageError come out of it.
CLI::App* add_synth_command(CLI::App& app);

} // namespace hsgm::pipeline
