#include "pipeline/ledger/ledger.h"
#include "pipeline/ledger/succession.h"
#include "tests/unit/io/sample_rasters.h"

#include "tests/catch.h"

#include <sqlite3.h>

#include <filesystem>

using namespace hsgm::ledger;
using hsgm::io::samples::bytes_of_file;
using hsgm::io::samples::put_bytes;
using hsgm::io::samples::TemporaryFolder;
using hsgm::tiling::Rect;
namespace fs = std::filesystem;

namespace {

const Rect kA{0, 0, 64, 64};
const Rect kB{0, 64, 64, 64};

void change_state(Ledger& ledger, const Rect& rect, TileState state)
{
    TileEvent event;
    event.stage = "match";
    event.rect = rect;
    event.state = state;
    ledger.commit(std::vector{event});
}

// Many rows, so that a transaction over all of them spills into the file before its end.
std::vector<Rect> many_tiles()
{
    std::vector<Rect> tiles;
    for (int i = 0; i < 5000; ++i) {
        tiles.push_back({i * 64, 0, 64, 64});
    }
    return tiles;
}

// A connection that is half way through a transaction and has the file for itself.
class HalfWay {
public:
    explicit HalfWay(const std::string& path)
    {
        REQUIRE(sqlite3_open(path.c_str(), &handle_) == SQLITE_OK);
        run("PRAGMA cache_size = 5");
        run("BEGIN EXCLUSIVE");
        run("UPDATE tiles SET reason = 'half way'");
    }
    ~HalfWay() { sqlite3_close(handle_); }
    HalfWay(const HalfWay&) = delete;
    HalfWay& operator=(const HalfWay&) = delete;
    void run(const char* sql)
    {
        REQUIRE(sqlite3_exec(handle_, sql, nullptr, nullptr, nullptr) == SQLITE_OK);
    }

private:
    sqlite3* handle_ = nullptr;
};

int half_way_in(const std::vector<TileRow>& tiles)
{
    return static_cast<int>(std::count_if(tiles.begin(), tiles.end(), [](const TileRow& row) {
        return row.reason == "half way";
    }));
}

} // namespace

TEST_CASE("successors of a ledger are numbered, and the last one counts")
{
    const TemporaryFolder folder;
    const fs::path first = folder / "tiles-0-of-3.sqlite";
    CHECK(successor_of(first) == folder / "tiles-0-of-3.2.sqlite");
    CHECK(successor_of(successor_of(first)) == folder / "tiles-0-of-3.3.sqlite");
    CHECK(number_of_successions(first) == 0);
    CHECK(number_of_successions(folder / "tiles-0-of-3.12.sqlite") == 11);
    CHECK(latest_of(first) == first);
    for (const char* name : {"tiles-0-of-3.sqlite", "tiles-0-of-3.2.sqlite"}) {
        put_bytes(folder / name, "");
    }
    CHECK(latest_of(first) == folder / "tiles-0-of-3.2.sqlite");
    put_bytes(folder / "tiles-0-of-3.3.sqlite", "");
    CHECK(latest_of(first) == folder / "tiles-0-of-3.3.sqlite");
    CHECK(latest_of(folder / "tiles-1-of-3.sqlite") == folder / "tiles-1-of-3.sqlite");
}

TEST_CASE("a ledger that is locked half way through a transaction is read as it was before")
{
    const TemporaryFolder folder;
    {
        Ledger ledger(folder / "x.sqlite");
        ledger.take({}, false);
        ledger.plan("match", many_tiles());
    }
    const std::string before = bytes_of_file(folder / "x.sqlite");
    const HalfWay other(folder / "x.sqlite");
    REQUIRE(bytes_of_file(folder / "x.sqlite") != before); // it has written already
    const Contents contents = read_ledger(folder / "x.sqlite");
    CHECK(contents.tiles.size() == 5000);
    CHECK(half_way_in(contents.tiles) == 0);
    copy_ledger(folder / "x.sqlite", folder / "y.sqlite");
    CHECK(half_way_in(Ledger(folder / "y.sqlite").tiles("match")) == 0);
    CHECK_FALSE(fs::exists(folder / "y.sqlite-journal"));
}

TEST_CASE("who finds a successor beside its ledger can record nothing more")
{
    const TemporaryFolder folder;
    Ledger first(folder / "x.sqlite");
    first.take({}, false);
    first.plan("match", std::vector{kA, kB});
    change_state(first, kA, TileState::running);
    copy_ledger(folder / "x.sqlite", folder / "copy");
    REQUIRE(publish_successor(folder / "copy", folder / "x.2.sqlite"));
    Ledger second(folder / "x.2.sqlite");
    const Owner owner = second.take({}, true);
    CHECK(owner.token == 2);
    CHECK(owner.part == 1);
    CHECK_THROWS_AS(change_state(first, kA, TileState::done), TakenOverError);
    CHECK(second.tiles("match")[0].state == TileState::pending);
    CHECK(second.tiles("match")[0].deaths == 1);
    change_state(second, kB, TileState::running);
}

TEST_CASE("of two that take over at once, one gives way")
{
    const TemporaryFolder folder;
    Ledger(folder / "x.sqlite").take({}, false);
    copy_ledger(folder / "x.sqlite", folder / "one");
    copy_ledger(folder / "x.sqlite", folder / "other");
    CHECK(publish_successor(folder / "one", folder / "x.2.sqlite"));
    CHECK_FALSE(publish_successor(folder / "other", folder / "x.2.sqlite"));
    CHECK_FALSE(fs::exists(folder / "other"));
}

TEST_CASE("a damaged ledger has no copy")
{
    const TemporaryFolder folder;
    put_bytes(folder / "x.sqlite", std::string(5000, 't'));
    CHECK_THROWS_AS(copy_ledger(folder / "x.sqlite", folder / "y.sqlite"), DamagedError);
    CHECK_FALSE(fs::exists(folder / "y.sqlite"));
}
