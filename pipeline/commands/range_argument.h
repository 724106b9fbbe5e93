#pragma once

#include "tiling/disparity_range.h"

#include <string>

namespace hsgm::pipeline {

/// The range of `--disparity MIN,MAX`, both ends inclusive. Throws ConfigError for anything
/// else, and for a reversed range.
tiling::DisparityRange parse_range(const std::string& text);

} // namespace hsgm::pipeline
