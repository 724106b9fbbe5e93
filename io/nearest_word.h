#pragma once

#include <string>
#include <vector>

namespace hsgm::io {

/// The candidate that a mistyped word most likely means; empty where none is near. Near is:
/// at most one letter in three added, lost, changed, or swapped with its neighbour.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

} // namespace hsgm::io
