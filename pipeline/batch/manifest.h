#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace hsgm::pipeline {

/// One pair of an archive: what its job is called, and what it has of its own.
struct BatchPair {
    std::string name;
    std::string left;
    std::string right;
    /// Keys of the configuration with values as in YAML: {"matcher.disparity", "[0, 63]"}.
    std::vector<std::pair<std::string, std::string>> overrides;
};

/// The pairs of an archive:
///
///   - a folder: one pair for each folder in it with a left.* and a right.*, and for each two
///     files NAME_left.* and NAME_right.*;
///   - a CSV file: a first row with the columns name, left, right and any keys of the
///     configuration; an empty cell overrides nothing;
///   - a YAML file: `pairs:`, a list of {name, left, right, set: {KEY: VALUE, ...}}.
///
/// Names may be left out where the left image's name will do. Relative paths start at the
/// manifest's folder. Throws ConfigError: nothing there, an unknown column or key, a name that
/// comes twice or is no file name.
std::vector<BatchPair> read_manifest(const std::filesystem::path& path);

} // namespace hsgm::pipeline
