#pragma once

#include "pipeline/job.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// What is to be fused, and where it goes.
struct FuseRequest {
    std::vector<std::filesystem::path> runs; ///< folders of finished runs of raw pairs
    std::filesystem::path folder;            ///< of the result
    OutputPaths outputs;                     ///< the DSM's, its companions' and the hillshades'
    int threads = 0;                         ///< 0: one for each processor
    std::optional<std::uint64_t> memory_bytes;
    bool resume = false; ///< do nothing where the same was fused already
};

/// The outputs of a fused DSM in a folder.
OutputPaths fused_outputs(const std::filesystem::path& folder, bool hillshade, bool quicklooks);

/// Fuses finished runs into one DSM with its companions and run.json, which says how each was
/// laid. The order of the folders changes nothing. Throws ConfigError for folders that hold no
/// finished run of a raw pair, or ones that differ in map or cells, BudgetError where the
/// memory is too small, and what `fuse_pairs` throws.
void fuse_runs(const FuseRequest& request);

} // namespace hsgm::pipeline
