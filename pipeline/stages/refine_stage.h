#pragma once

#include "io/geo_reference.h"
#include "pipeline/job.h"
#include "pipeline/stages/dsm_stage.h"
#include "pipeline/stages/first_pass.h"
#include "pipeline/stages/prepare_stage.h"

#include <array>
#include <cstdint>
#include <optional>

namespace hsgm::pipeline {

/// Totals of a finished match, for the closing message and `run.json`.
struct MatchSummary {
    std::int64_t pixels = 0;
    std::int64_t with_value = 0;
    /// Pixels that carry each bit of the reasons raster.
    std::array<std::int64_t, 16> with_reason{};
    std::optional<DsmSummary> dsm; ///< of raw pairs
};

/// The second pass: checks, fractions and filters of the whole image, written as
/// GeoTIFFs in one canonical order of blocks, whatever tiles the first pass had; so the
/// files' bytes are the same too. Pieces are computed side by side and written in turn.
/// Outputs get their names only when all of them are whole.
MatchSummary refine_and_write(const FirstPass& first_pass, const PreparedPair& prepared,
                              const matcher::PairShape& shape, const Job& job,
                              const io::GeoReference& geo);

/// Upper bound of the memory that `refine_and_write` takes with this many threads.
std::int64_t refine_bytes(const matcher::PairShape& shape, const matcher::Options& options,
                          int threads);

} // namespace hsgm::pipeline
