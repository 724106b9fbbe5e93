#pragma once

#include "pipeline/stages/plan_stage.h"

#include <optional>
#include <string>

namespace hsgm::pipeline {

/// How a plan is told.
struct PlanReport {
    bool json = false;
    std::optional<int> shards; ///< also what each part of a run shared out like that would take
    bool time =
        true; ///< also how long it may take: the one thing that differs from call to call
};

/// The plan on standard output, as a table or as JSON.
void print_plan(const PlannedJob& planned, const PlanReport& report);

/// "16 of 1024 px, 3 in flight", or "untiled".
std::string tile_text(const Budget& budget);

} // namespace hsgm::pipeline
