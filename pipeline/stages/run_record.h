#pragma once

#include "pipeline/stages/assemble_stage.h"
#include "pipeline/stages/run_books.h"

#include <nlohmann/json_fwd.hpp>

namespace hsgm::pipeline {

/// What a finished run says of itself in run.json (docs/outputs.md): what defines the result,
/// tiles, stages with their times, completeness and reasons, the seam figure, and bytes and
/// SHA-256 of every output. Reads the outputs, and records that as stages of its own.
nlohmann::ordered_json run_record(const PlannedJob& planned, const RunLayout& layout,
                                  const MatchSummary& summary, const ledger::Facts& fingerprint,
                                  const OwnedLedger& book);

} // namespace hsgm::pipeline
