#pragma once

#include <CLI/App.hpp>

namespace hsgm::pipeline {

/// Adds `hsgm batch`: an archive of pairs, one run each.
CLI::App* add_batch_command(CLI::App& app);

} // namespace hsgm::pipeline
