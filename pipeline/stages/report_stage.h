#pragma once

#include "pipeline/stages/run_layout.h"

namespace hsgm::pipeline {

/// Writes report.html into the folder of a run: what run.json says, where there is one, and
/// what the ledgers know of stages, tiles and workers. One file, nothing loaded from elsewhere
/// but pictures beside it. Throws InputError where the folder holds no run.
void write_report(const RunLayout& layout);

} // namespace hsgm::pipeline
