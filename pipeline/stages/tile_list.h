#pragma once

#include "pipeline/ledger/ledger.h"
#include "pipeline/stages/first_pass.h"
#include "pipeline/stages/plan_stage.h"
#include "pipeline/stages/run_layout.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// The scratch parts of one shard: that of this owner, and those of owners that it took over
/// from, which may yet write to theirs.
class ShardParts {
public:
    /// Opens this owner's part, or makes it where it is missing or not whole. Throws
    /// StorageError.
    ShardParts(const PlannedJob& planned, const RunLayout& layout, tiling::Shard shard,
               int own_part);

    std::shared_ptr<FirstPassPart> own() const { return own_; }
    /// Whether the results of a tile are there, as its row says.
    bool holds(const ledger::TileRow& row) const;

private:
    const FirstPassPart* part(int number) const;

    int own_part_;
    std::shared_ptr<FirstPassPart> own_;
    std::map<int, std::unique_ptr<FirstPassPart>> earlier_;
};

/// A piece of the shard that is to be matched.
struct ListedTile {
    tiling::Rect core;
    bool suspect = false; ///< processes died at it: to be matched alone
    std::string avoid;    ///< the worker that failed at it
};

/// What is left to be matched of the rows `band`, in the order of the run, and puts it into the
/// ledger. Tiles of an earlier tiling that are done stay done: of a tile of this one, only what
/// they leave is listed. Results that are not what their row says are done again.
std::vector<ListedTile> list_tiles(const PlannedJob& planned, const tiling::Rect& band,
                                   ledger::Ledger& ledger, const ShardParts& parts);

} // namespace hsgm::pipeline
