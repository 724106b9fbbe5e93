#pragma once

#include "pipeline/ledger/fingerprint.h"
#include "pipeline/match_worker.h"
#include "tiling/shard.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace hsgm::pipeline {

/// The parts of a run that can be done apart, one after the other. `all` without a shard is a
/// run in one process; with one, this process does its share, and the last one assembles.
enum class RunStage { all, coarse, tiles, assemble };

/// Which part of a run is to be done, where its books are, and what becomes of an earlier
/// attempt. Nothing here changes a pixel.
struct RunManner {
    /// Of the ledger and of what lies between the stages; empty: a hidden folder beside the
    /// disparities that goes away at the end, so that there is nothing to resume.
    std::filesystem::path folder;
    RunStage stage = RunStage::all;
    std::optional<tiling::Shard> shard;
    bool resume = false;    ///< go on where an earlier attempt stopped; a new one is begun else
    bool restart = false;   ///< throw an unfinished attempt away
    bool take_over = false; ///< the process that holds the shard is known to be gone
    /// What defines the result, beside the images: a resumed run must have the same.
    ledger::Facts settings;
    /// Puts something between the run and each of its workers; empty: nothing.
    std::function<std::shared_ptr<MatchWorker>(std::shared_ptr<MatchWorker>)> adapt_worker;
    /// The complete configuration, to be written beside the result; empty: none.
    std::string used_yaml;

    bool is_durable() const { return !folder.empty(); }
    /// Throws ConfigError where options contradict each other.
    void validate() const;
};

} // namespace hsgm::pipeline
