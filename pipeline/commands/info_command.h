#pragma once

#include <CLI/App.hpp>

namespace hsgm::pipeline {

/// Adds `hsgm info`: versions, processor, memory and what this build can do.
CLI::App* add_info_command(CLI::App& app);

} // namespace hsgm::pipeline
