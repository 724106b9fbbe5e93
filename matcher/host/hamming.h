#pragma once

#include "matcher/host/aligned.h"
#include "matcher/host/cost_row.h"
#include "matcher/options.h"

namespace hsgm::matcher::host {

/// Costs of a census: the number of bits that differ, weighed and capped as docs/algorithm.md,
/// section 3, says. Vector code, chosen for the processor at run time. `split` is room for
/// the planes in another form.
void hamming_costs(Cost cost, const CostRow& row, Buffer<std::uint8_t>& split,
                   std::uint8_t* costs);

} // namespace hsgm::matcher::host
