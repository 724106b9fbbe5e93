#pragma once

#include "pipeline/stages/owned_ledger.h"
#include "pipeline/stages/plan_stage.h"
#include "pipeline/stages/run_layout.h"
#include "pipeline/stages/run_manner.h"

// What an earlier attempt left in a run's folder, and what becomes of it.
namespace hsgm::pipeline {

/// A fingerprint as it is kept among the facts of every ledger.
ledger::Facts as_facts(const ledger::Facts& fingerprint);

/// Whether all stages of the run in this folder are done, and no tile failed.
bool is_finished(const RunLayout& layout);
/// Notes that the image was assembled from so many tiles; and whether it was, from the same.
void mark_assembled(const OwnedLedger& book, std::size_t tiles_failed, int tiles_done);
bool is_assembled(const OwnedLedger& book, std::size_t tiles_failed, int tiles_done);

/// Before the coarse stage, with its lock: throws away a finished run, or an unfinished one on
/// request; else leaves one to be resumed alone. Throws ConfigError where it is neither told to
/// resume nor to restart, or where what defines the result has changed, with the difference;
/// StorageError where a process is at work on what would go.
void judge_earlier_run(const RunLayout& layout, const RunManner& manner,
                       const ledger::Facts& fingerprint);

/// Throws ConfigError where the images that an earlier attempt has prepared have other pixels
/// than those of today, with the difference. Reads them whole where their files were touched.
void judge_earlier_pixels(const RunLayout& layout, const PlannedJob& planned);

/// Removes everything that a run keeps beside its outputs, as far as that can be done.
void discard(const RunLayout& layout);

/// The same before the tiles of one shard, which throws nothing away.
void judge_earlier_shard(const RunLayout& layout, tiling::Shard shard, const RunManner& manner,
                         const ledger::Facts& fingerprint);

/// Before a later stage alone: throws ConfigError unless the coarse stage is done, of the same
/// run.
void require_coarse_stage(const RunLayout& layout, const ledger::Facts& fingerprint);

} // namespace hsgm::pipeline
