#pragma once

#include "pipeline/ledger/ledger.h"
#include "pipeline/stages/run_layout.h"

#include <optional>
#include <string>
#include <vector>

namespace hsgm::pipeline {

/// One ledger of a run, as it stands, and whether a process is at work on it.
struct Book {
    std::string name; ///< "coarse", "tiles 0/3", "assemble"
    std::optional<tiling::Shard> shard;
    ledger::Contents contents;
    bool at_work = false;
    std::string holder; ///< "process 12 on node7", the last one to have the lock
};

/// All ledgers of a run: the coarse stage, the shards, the assembly. A damaged one counts as
/// empty. Throws InputError where the folder holds no run.
std::vector<Book> read_books(const RunLayout& layout);

/// Tiles of a book by state.
struct TileCounts {
    int all = 0;
    int done = 0;
    int failed = 0;
    int running = 0;
    std::int64_t pixels_all = 0;
    std::int64_t pixels_done = 0;
};
TileCounts count_tiles(const Book& book);

/// Pixels that a book's owner matches in a second, as far as its attempts tell; 0: unknown.
double pixels_per_second(const Book& book);

/// Whether the assembly is done, of whatever tiles there were.
bool is_assembled(const std::vector<Book>& books);

} // namespace hsgm::pipeline
