#pragma once

#include "matcher/matcher.h"

#include <cstdint>

// Bounds of memory that a caller with many tiles needs beside those of Matcher.
namespace hsgm::matcher {

/// Upper bound of what a coarse solution keeps for the tiles.
std::int64_t coarse_kept_bytes(const Matcher& matcher);

/// Upper bound of what a tile takes before and after it is matched: the images of its support,
/// or its result. While it is matched: Matcher::tile_bytes.
std::int64_t waiting_tile_bytes(const Matcher& matcher, int tile_size_px);

/// Upper bound of what `solve_hmi_table` takes for such a pair, with its two images.
std::int64_t hmi_table_bytes(const Matcher& matcher);

} // namespace hsgm::matcher
