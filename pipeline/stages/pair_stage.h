#pragma once

#include "pipeline/stages/owned_ledger.h"
#include "pipeline/stages/plan_stage.h"
#include "pipeline/stages/prepare_stage.h"
#include "pipeline/stages/run_layout.h"

#include <memory>

namespace hsgm::pipeline {

/// What every tile of a pair needs.
struct PairBasis {
    std::shared_ptr<const PreparedPair> images;
    std::shared_ptr<const matcher::Matcher> matcher;
};

/// The coarse stage: both images as the matcher wants them, in the work folder; tones and, for
/// cost hmi, the table as facts of the ledger, so that every process has the same. Does what is
/// not done yet. `durable`: returns when all is on the disk.
void prepare_pair(const PlannedJob& planned, const RunLayout& layout, const OwnedLedger& book,
                  bool durable);

/// Opens the images that `prepare_pair` left; `facts` are those of its ledger. Throws
/// StorageError where something is missing.
std::unique_ptr<PreparedPair> open_images(const PlannedJob& planned, const RunLayout& layout,
                                          const ledger::Facts& facts);

/// Opens what `prepare_pair` left; `facts` are those of its ledger. Throws StorageError where
/// something is missing.
PairBasis open_pair(const PlannedJob& planned, const RunLayout& layout,
                    const ledger::Facts& facts);

/// The coarsest level, solved whole; Interrupted comes out of it.
std::shared_ptr<const matcher::CoarseSolution> solve_coarse(const PairBasis& pair);

} // namespace hsgm::pipeline
