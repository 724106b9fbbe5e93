#pragma once

#include <filesystem>

// A process that takes a ledger over from one that still has it (frozen, perhaps in the midst
// of a commit, or on a node that nobody can reach) goes on in a copy with a number of its own:
//
//     tiles-0-of-3.sqlite, tiles-0-of-3.2.sqlite, tiles-0-of-3.3.sqlite ...
//
// The last one counts. Whatever the earlier process does when it wakes up, it does to its own
// file and journal, which nobody reads any more; and before a commit it looks for a successor.
namespace hsgm::ledger {

/// The last one of a ledger's files, by the name of the first; the first where there is none.
std::filesystem::path latest_of(const std::filesystem::path& first);

/// How many came before the file of this name: 0 for "x.sqlite", 1 for "x.2.sqlite".
int number_of_successions(const std::filesystem::path& path);

/// Name of the file that takes this one's place, there or not: "x.2.sqlite" for "x.sqlite".
std::filesystem::path successor_of(const std::filesystem::path& path);

/// Copies a ledger as it was after its last commit, also where another process keeps it locked:
/// its journal is copied with it, and rolled back in the copy. Waits a few seconds for a moment
/// at which nobody writes. Not for a ledger that this process has open itself: closing a file
/// gives up a process's locks on it. Throws StorageError where it cannot be copied,
/// DamagedError where the copy does not hold together; then there is no copy.
void copy_ledger(const std::filesystem::path& from, const std::filesystem::path& to);

/// Gives a copy the name of a successor. False where another process was first; then the copy
/// is gone.
bool publish_successor(const std::filesystem::path& copy,
                       const std::filesystem::path& successor);

} // namespace hsgm::ledger
