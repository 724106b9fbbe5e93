#pragma once

#include "pipeline/stages/match_stage.h"

#include <chrono>

namespace hsgm::pipeline {

/// One line on standard error about what is going to happen.
void log_plan(const PlannedJob& planned);

/// What came of it: completeness, and how many pixels carry each reason.
void log_summary(const MatchSummary& summary, const PlannedJob& planned);

/// Shows the tiles done, pace and time left: a bar on a terminal, a plain line for every tenth
/// elsewhere.
class ProgressLog {
public:
    ProgressLog();
    void operator()(const TileProgress& progress);

private:
    std::chrono::steady_clock::time_point start_;
    bool terminal_;
    int last_percent_ = -1;
};

} // namespace hsgm::pipeline
