#pragma once

#include "pipeline/geometry/pair_geometry.h"

#include <cstdint>

namespace hsgm::pipeline {

/// Upper bound of the memory that finding this geometry took, the program itself not counted:
/// reduced images of at most 2048 px a side, features of them and of patches, and their match.
/// It does not grow with images beyond that size. Known only once it is found, for heights and
/// frame are part of the answer.
std::int64_t search_bytes(const geometry::PairGeometry& pair);

} // namespace hsgm::pipeline
