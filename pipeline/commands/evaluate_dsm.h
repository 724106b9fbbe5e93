#pragma once

#include <CLI/App.hpp>

namespace hsgm::pipeline {

/// Adds `evaluate dsm` to the command `evaluate`.
void add_evaluate_dsm(CLI::App& evaluate);

} // namespace hsgm::pipeline
