#pragma once

#include "matcher/host/cost_row.h"
#include "matcher/options.h"

#include <cstdint>

namespace hsgm::matcher::host {

/// Costs of a census: the number of bits that differ, weighed and capped as docs/algorithm.md,
/// section 3, says. Vector code, chosen for the processor at run time.
void hamming_costs(Cost cost, const CostRow& row, std::uint8_t* costs);

} // namespace hsgm::matcher::host
