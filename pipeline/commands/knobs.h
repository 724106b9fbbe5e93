#pragma once

#include "io/config.h"

#include <CLI/App.hpp>

#include <memory>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// The options that `run`, `match` and `plan` share. Each stands for a key of the
/// configuration and overrides it, as `--set` does for any key.
struct Knobs {
    std::string profile;
    std::string tile_size;
    std::string threads;
    std::string memory;
    std::string device;
    std::vector<std::string> overrides;

    /// Applies them to a document, `--set` last.
    void apply(io::ConfigDocument& document) const;
};

/// Adds the options to a command; `knobs` must outlive the parsing.
void add_knobs(CLI::App& command, Knobs& knobs);

} // namespace hsgm::pipeline
