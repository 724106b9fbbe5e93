#pragma once

#include "matcher/hmi.h"
#include "matcher/host/cost_row.h"

namespace hsgm::matcher::host {

/// Costs of `hmi`: the table's, by the tones of both pixels.
void lookup_costs(const HmiTable& table, const CostRow& row, std::uint8_t* costs);

} // namespace hsgm::matcher::host
