#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hsgm::seam {

struct ChildResult {
    int exit_code = -1; ///< -1: ended by a signal
    std::int64_t peak_bytes = 0;
    double seconds = 0;
};

/// Runs a program to its end. Its messages go where ours go.
ChildResult run_child(const std::vector<std::string>& command);

} // namespace hsgm::seam
