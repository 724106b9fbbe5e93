#pragma once

#include "pipeline/ledger/database.h"
#include "pipeline/ledger/fingerprint.h"
#include "pipeline/ledger/rows.h"

#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace hsgm::ledger {

/// Another process took over what this one worked on; whatever it still does is not recorded.
class TakenOverError : public io::StorageError {
    using StorageError::StorageError;
};

/// A ledger of a layout that this version does not know.
class VersionError : public io::ConfigError {
    using ConfigError::ConfigError;
};

/// The book of one shard: facts about it, who had it, and a row for every tile and stage.
/// Crash-safe: each call below is recorded whole or not at all, and is on the disk when it
/// returns (unless it is fleeting: then it survives the process, but not a power cut).
/// Thread-safe. Throws StorageError where the disk fails or is full.
class Ledger {
public:
    /// Opens the ledger, or begins one. Throws DamagedError where the file is none or is cut
    /// short, VersionError where another version wrote it.
    explicit Ledger(const std::filesystem::path& path, bool fleeting = false);

    Facts facts() const;
    void set_facts(const Facts& facts);

    /// Makes the caller its owner: `owner.token` is set one above the last, and commits of
    /// earlier owners throw TakenOverError from then on. Tiles that were running when the last
    /// one ended are pending again, their deaths counted. With `new_part` the owner gets a
    /// scratch part of its own, because the last one may yet write to its part: at least
    /// `owner.part`.
    Owner take(Owner owner, bool new_part);
    std::vector<Owner> owners() const;

    /// Tiles of a stage in the order in which they were planned.
    std::vector<TileRow> tiles(const std::string& stage) const;

    /// Replaces all tiles of a stage that are not done: those of `tiles` are pending, with the
    /// attempts and deaths that tiles of the same rectangle had. (One that is done and among
    /// them is pending again.)
    void plan(const std::string& stage, std::span<const tiling::Rect> tiles);

    /// Records changes, all at once. Throws TakenOverError, also where the ledger has a
    /// successor (succession.h).
    void commit(std::span<const TileEvent> events);

    const std::filesystem::path& path() const { return database_.path(); }

private:
    void begin();
    void require_token();
    void apply(const TileEvent& event);

    mutable std::mutex mutex_;
    mutable Database database_;
    std::int64_t token_ = 0;
    int part_ = 0;
};

/// All that a ledger holds, for those who only look.
struct Contents {
    Facts facts;
    std::vector<Owner> owners;
    std::vector<TileRow> tiles;
    std::vector<AttemptRow> attempts;
};

/// Reads a ledger, also while its owner writes, or was frozen in the midst of that. Throws as
/// the constructor of Ledger does, and StorageError where there is none.
Contents read_ledger(const std::filesystem::path& path);

} // namespace hsgm::ledger
