#pragma once

#include "tiling/rect.h"

#include <cstdint>
#include <string>

namespace hsgm::ledger {

enum class TileState { pending, running, done, failed };

const char* name(TileState state);
/// Throws std::invalid_argument for a name that is none.
TileState state_from_name(const std::string& name);

/// One tile in one stage, as it stands. Stages that go over the image as a whole have one.
struct TileRow {
    std::string stage;
    tiling::Rect rect; ///< in pixels of the left image
    TileState state = TileState::pending;
    int attempts = 0;     ///< begun so far
    int deaths = 0;       ///< of those, how many the process did not live through
    int part = 0;         ///< which of the shard's scratch parts holds a done tile's results
    std::string worker;   ///< of the last attempt, as are the two below
    double started_s = 0; ///< since 1970, by the clock of the machine; never decides anything
    double seconds = 0;   ///< that it took, by a clock that is never set
    std::string checksum; ///< of a done tile's results
    std::string reason;   ///< of the last failure
};

/// One attempt at a tile that has ended.
struct AttemptRow {
    std::string stage;
    tiling::Rect rect;
    std::int64_t token = 0; ///< of the owner that made it
    std::string worker;
    double started_s = 0;
    double seconds = 0;
    std::string outcome; ///< done, failed or died
    std::string reason;
};

/// A process that had the ledger. Each has a higher token than the one before it.
struct Owner {
    std::int64_t token = 0;
    int part = 0; ///< the scratch part that it writes to
    std::string host;
    std::int64_t pid = 0;
    std::string job;     ///< what the engine calls it, without the count of restarts
    int restarts = 0;    ///< as the engine counts them
    std::string program; ///< name and version
    double started_s = 0;
};

/// A change of a tile's state. To `running`: an attempt begins. From there to `done`, back to
/// `pending` (it failed or was dropped, and is to be tried again) or to `failed` for good.
struct TileEvent {
    std::string stage;
    tiling::Rect rect;
    TileState state = TileState::pending;
    std::string worker;
    double started_s = 0;
    double seconds = 0;
    std::string checksum;
    std::string reason; ///< empty where an attempt was merely dropped
};

} // namespace hsgm::ledger
