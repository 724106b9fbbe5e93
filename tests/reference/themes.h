#pragma once

#include "tests/reference/agreement.h"

#include <cstdint>

namespace hsgm::reference {

/// Images of a few pixels.
Theme tiny();
/// Small images, whatever the options.
Theme small();
/// Lines of pixels, whose coarse levels are a handful of them.
Theme thin();
/// True shifts, several windows and levels, ranges well above what pruning leaves.
Theme pruned();
/// Ranges far beyond what narrow images can meet.
Theme wide_ranges();
/// Penalties whose path costs need sixteen bits, and the last ones that fit eight.
Theme dear();
/// Several windows of one mode.
Theme of_mode(Mode mode);
/// One cost and number of paths, whose path costs take eight bits or (`wide`) sixteen.
Theme of_cost(Cost cost, int paths, bool wide);
/// The default options on images of a few windows.
Theme defaults();

/// Checks seeds first.. of a theme. HSGM_REFERENCE_CASES sets another number of cases,
/// HSGM_REFERENCE_SEED repeats the one that a failure named.
void compare(const Theme& theme, std::uint64_t first, int cases);

} // namespace hsgm::reference
