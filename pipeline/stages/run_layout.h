#pragma once

#include "tiling/shard.h"

#include <filesystem>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// Where a run keeps its books and what lies between its stages; docs/outputs.md names the
/// files.
///
///     ledger/coarse.sqlite  tiles-0-of-3.sqlite ...  assemble.sqlite   each with a .lock
///     ledger/tiles-0-of-3.2.sqlite   of a process that took shard 0 over (ledger/succession.h)
///     work/pair/            both images as the matcher wants them
///     work/tiles-0-of-3/0/  first-pass results of a shard, of its first owner
struct RunLayout {
    std::filesystem::path root;

    std::filesystem::path ledgers() const { return root / "ledger"; }
    /// The file that counts: of a ledger that was taken over, the last one.
    std::filesystem::path coarse_ledger() const;
    std::filesystem::path assemble_ledger() const;
    std::filesystem::path tiles_ledger(tiling::Shard shard) const;
    std::filesystem::path work() const { return root / "work"; }
    std::filesystem::path pair() const { return work() / "pair"; }
    std::filesystem::path part(tiling::Shard shard, int number) const;

    static std::filesystem::path lock_of(std::filesystem::path ledger)
    {
        return ledger.replace_extension(".lock");
    }

    /// The shards that have a ledger, in order of count and index.
    std::vector<tiling::Shard> shards() const;
    /// All ledgers that are there, those that were taken over included.
    std::vector<std::filesystem::path> all_ledgers() const;
};

/// "3-of-7", the name of a shard in paths.
std::string name(tiling::Shard shard);

} // namespace hsgm::pipeline
