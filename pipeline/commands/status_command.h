#pragma once

#include <CLI/App.hpp>

namespace hsgm::pipeline {

/// Adds `hsgm status DIR`: how far a run is, read from its ledgers, also while it works.
CLI::App* add_status_command(CLI::App& app);

/// Adds `hsgm report DIR`: report.html of a run, finished or not.
CLI::App* add_report_command(CLI::App& app);

} // namespace hsgm::pipeline
