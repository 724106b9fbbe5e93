#pragma once

#include "pipeline/pairs/pair_list.h"

#include <string>

namespace hsgm::pipeline {

/// How an earlier attempt is dealt with.
struct PairsManner {
    bool resume = false;
    bool restart = false;
    std::string log_level = "info"; ///< of the pairs' logs
};

/// Carries out every pair of a list as a run of its own, one after the other, each in a process
/// and a folder of its own (`pairs/NAME`, with its configuration beside it, `pairs/NAME.yaml`),
/// and fuses them into one DSM. A pair that fails does not disturb the others: then throws
/// FailedTiles at the end, or, where less than two are left, what the first of them ended with.
void run_pairs(const PairList& list, const PairsManner& manner);

} // namespace hsgm::pipeline
