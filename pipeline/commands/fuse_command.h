#pragma once

#include <CLI/App.hpp>

namespace hsgm::pipeline {

/// `hsgm fuse`: one DSM from finished runs of raw pairs.
CLI::App* add_fuse_command(CLI::App& app);

} // namespace hsgm::pipeline
