#pragma once

#include "pipeline/batch/manifest.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// How an archive of pairs is worked through.
struct BatchOptions {
    std::filesystem::path config;
    std::filesystem::path folder;       ///< each pair's results go to folder/NAME
    int jobs = 1;                       ///< at once
    std::vector<std::string> overrides; ///< KEY=VALUE for all pairs; a pair's own win
    bool resume = false;
    bool restart = false;
    std::string log_level = "info"; ///< of the jobs' logs
};

/// What came of one pair.
struct BatchResult {
    std::string name;
    int exit_code = -1; ///< of its run; -1: not begun
    double seconds = 0;
    std::optional<int> tiles_done;
    std::optional<int> tiles_failed;
    std::optional<double> complete_percent;
    std::optional<double> seam_ratio;
    std::string message; ///< the error, where there was one
};

/// "done", "failed tiles", "refused: configuration", ... of an exit code.
std::string state_of(const BatchResult& result);

/// Carries out every pair as a process of its own, `jobs` at a time, each with its share of the
/// machine's threads and memory unless the configuration says otherwise. A pair that fails
/// does not disturb the others. `told` hears of each when it ends. The log of a pair is
/// folder/NAME/logs/job.log; summary.csv, with a row for each pair, is written after each end.
///
/// All configurations are read before any pair begins: throws ConfigError for the first bad
/// one, naming the pair. When asked to stop, stops its jobs, writes the summary and throws
/// Interrupted.
std::vector<BatchResult> run_batch(const std::vector<BatchPair>& pairs,
                                   const BatchOptions& options,
                                   const std::function<void(const BatchResult&)>& told);

} // namespace hsgm::pipeline
