#pragma once

#include <map>
#include <string>
#include <vector>

namespace hsgm::ledger {

/// Names and values that define a result: settings, inputs, program. Never tile size, threads,
/// memory or paths.
using Facts = std::map<std::string, std::string>;

/// What differs, one entry a name: "matcher.p2: 192 before, 160 now". Empty: the same.
std::vector<std::string> differences(const Facts& before, const Facts& now);

} // namespace hsgm::ledger
