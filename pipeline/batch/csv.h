#pragma once

#include <string>
#include <vector>

namespace hsgm::pipeline {

/// Rows of comma-separated values: cells may be quoted, with quotes doubled inside, and then
/// hold commas and line ends (RFC 4180). Spaces round unquoted cells are dropped, and so are
/// empty rows and those that begin with #. Throws ConfigError for a quote that does not end.
std::vector<std::vector<std::string>> parse_csv(const std::string& text,
                                                const std::string& name);

/// One row, ended by a line end; cells are quoted where they must be.
std::string csv_row(const std::vector<std::string>& cells);

} // namespace hsgm::pipeline
