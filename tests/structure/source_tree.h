#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hsgm::structure {

/// A file of this project: its path from the project's root, with '/', and its lines.
struct SourceFile {
    std::string path;
    std::vector<std::string> lines;
};

/// Every C++ or CUDA source, header and shell script below the root, sorted by path.
/// Build trees, outputs and dot folders at the top do not count.
std::vector<SourceFile> read_sources(const std::string& root);

/// The folders at the top of the project, sorted: those that git tracks, or those on disk
/// (without build trees, outputs and dot folders) where this is not a git checkout.
std::vector<std::string> top_folders(const std::string& root);

/// The lines of `text`.
std::vector<std::string> split_lines(std::string_view text);

} // namespace hsgm::structure
