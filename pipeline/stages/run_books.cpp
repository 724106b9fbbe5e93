#include "pipeline/stages/run_books.h"

#include "io/error.h"
#include "pipeline/ledger/file_lock.h"
#include "pipeline/stages/tile_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace hsgm::pipeline {

namespace {

using ledger::TileState;

Book read_book(const std::string& name, const std::filesystem::path& path)
{
    Book book;
    book.name = name;
    try {
        book.contents = ledger::read_ledger(path);
    } catch (const ledger::DamagedError&) {
        book.contents = {}; // or just being made
    }
    const auto lock = RunLayout::lock_of(path);
    book.at_work = ledger::FileLock::is_held(lock);
    book.holder = ledger::FileLock::holder(lock);
    return book;
}

} // namespace

std::vector<Book> read_books(const RunLayout& layout)
{
    std::vector<Book> books;
    if (std::filesystem::exists(layout.coarse_ledger())) {
        books.push_back(read_book("coarse", layout.coarse_ledger()));
    }
    for (const tiling::Shard shard : layout.shards()) {
        books.push_back(read_book(fmt::format("tiles {}/{}", shard.index, shard.count),
                                  layout.tiles_ledger(shard)));
        books.back().shard = shard;
    }
    if (std::filesystem::exists(layout.assemble_ledger())) {
        books.push_back(read_book("assemble", layout.assemble_ledger()));
    }
    if (books.empty()) {
        throw io::InputError(fmt::format(
            "{} holds no run: there is no ledger in it; name the output folder of a hsgm run",
            layout.root.string()));
    }
    return books;
}

TileCounts count_tiles(const Book& book)
{
    TileCounts counts;
    for (const ledger::TileRow& row : book.contents.tiles) {
        if (row.stage != kMatchStage) {
            continue;
        }
        ++counts.all;
        counts.pixels_all += row.rect.area();
        counts.failed += row.state == TileState::failed;
        counts.running += row.state == TileState::running;
        if (row.state == TileState::done) {
            ++counts.done;
            counts.pixels_done += row.rect.area();
        }
    }
    return counts;
}

double pixels_per_second(const Book& book)
{
    if (book.contents.owners.empty()) {
        return 0;
    }
    const std::int64_t token = book.contents.owners.back().token;
    std::int64_t pixels = 0;
    double first_s = 0;
    double last_s = 0;
    for (const ledger::AttemptRow& attempt : book.contents.attempts) {
        if (attempt.token != token || attempt.stage != kMatchStage ||
            attempt.outcome != "done") {
            continue;
        }
        first_s = pixels == 0 ? attempt.started_s : std::min(first_s, attempt.started_s);
        last_s = std::max(last_s, attempt.started_s + attempt.seconds);
        pixels += attempt.rect.area();
    }
    return last_s > first_s ? static_cast<double>(pixels) / (last_s - first_s) : 0;
}

bool is_assembled(const std::vector<Book>& books)
{
    return std::any_of(books.begin(), books.end(), [](const Book& book) {
        return book.contents.facts.contains("assembled");
    });
}

} // namespace hsgm::pipeline
