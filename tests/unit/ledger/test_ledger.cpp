#include "pipeline/ledger/ledger.h"
#include "tests/unit/io/sample_rasters.h"

#include "tests/catch.h"

#include <sys/wait.h>
#include <unistd.h>

using namespace hsgm::ledger;
using hsgm::io::samples::TemporaryFolder;
using hsgm::tiling::Rect;

namespace {

const Rect kA{0, 0, 64, 64};
const Rect kB{0, 64, 64, 30};
const Rect kC{64, 0, 10, 94};

Owner process(std::int64_t pid)
{
    Owner owner;
    owner.host = "here";
    owner.pid = pid;
    owner.program = "hsgm 0";
    return owner;
}

TileEvent event(const Rect& rect, TileState state, const std::string& reason = "")
{
    TileEvent e;
    e.stage = "match";
    e.rect = rect;
    e.state = state;
    e.worker = "cpu 1";
    e.started_s = 100.5;
    e.seconds = 2.25;
    e.checksum = state == TileState::done ? "00ff" : "";
    e.reason = reason;
    return e;
}

// Begins every tile and lets it end.
void record(Ledger& ledger, const Rect& rect, TileState state, const std::string& reason = "")
{
    ledger.commit(std::vector{event(rect, TileState::running)});
    ledger.commit(std::vector{event(rect, state, reason)});
}

} // namespace

TEST_CASE("a ledger keeps facts and tiles over its closing")
{
    const TemporaryFolder folder;
    {
        Ledger ledger(folder / "x.sqlite");
        CHECK(ledger.take(process(1), false).token == 1);
        ledger.set_facts({{"a", "1"}, {"b", "it's\n\"quoted\""}});
        ledger.set_facts({{"a", "2"}});
        ledger.plan("match", std::vector{kA, kB, kC});
        record(ledger, kB, TileState::done);
        record(ledger, kA, TileState::failed, "no memory");
    }
    const Ledger ledger(folder / "x.sqlite");
    CHECK(ledger.facts() == Facts{{"a", "2"}, {"b", "it's\n\"quoted\""}});
    const auto tiles = ledger.tiles("match");
    REQUIRE(tiles.size() == 3);
    CHECK(tiles[0].rect == kA);
    CHECK(tiles[0].state == TileState::failed);
    CHECK(tiles[0].reason == "no memory");
    CHECK(tiles[1].rect == kB);
    CHECK(tiles[1].state == TileState::done);
    CHECK(tiles[1].worker == "cpu 1");
    CHECK(tiles[1].attempts == 1);
    CHECK(tiles[1].started_s == 100.5);
    CHECK(tiles[1].seconds == 2.25);
    CHECK(tiles[1].checksum == "00ff");
    CHECK(tiles[2].state == TileState::pending);
    CHECK(tiles[2].attempts == 0);
    CHECK(ledger.tiles("refine").empty());
}

TEST_CASE("a new plan keeps what is done and what is known of the same tiles")
{
    const TemporaryFolder folder;
    Ledger ledger(folder / "x.sqlite");
    ledger.take(process(1), false);
    ledger.plan("match", std::vector{kA, kB, kC});
    record(ledger, kA, TileState::done);
    record(ledger, kB, TileState::failed, "no memory");
    const Rect larger{64, 0, 64, 128};
    ledger.plan("match", std::vector{kB, larger});
    const auto tiles = ledger.tiles("match");
    REQUIRE(tiles.size() == 3);
    CHECK(tiles[0].rect == kA);
    CHECK(tiles[0].state == TileState::done);
    CHECK(tiles[1].rect == kB);
    CHECK(tiles[1].state == TileState::pending);
    CHECK(tiles[1].attempts == 1);
    CHECK(tiles[1].reason == "no memory");
    CHECK(tiles[2].rect == larger);
}

TEST_CASE("tiles of a process that died are pending again and the death is counted")
{
    const TemporaryFolder folder;
    {
        Ledger ledger(folder / "x.sqlite");
        ledger.take(process(1), false);
        ledger.plan("match", std::vector{kA, kB});
        ledger.commit(std::vector{event(kA, TileState::running)});
    }
    Ledger ledger(folder / "x.sqlite");
    CHECK(ledger.take(process(2), false).token == 2);
    const auto tiles = ledger.tiles("match");
    CHECK(tiles[0].state == TileState::pending);
    CHECK(tiles[0].deaths == 1);
    CHECK(tiles[0].attempts == 1);
    CHECK(tiles[1].deaths == 0);
    const auto attempts = read_ledger(folder / "x.sqlite").attempts;
    REQUIRE(attempts.size() == 1);
    CHECK(attempts[0].outcome == "died");
    CHECK(attempts[0].token == 1);
    CHECK(attempts[0].rect == kA);
}

TEST_CASE("who was taken over can record nothing more")
{
    const TemporaryFolder folder;
    Ledger first(folder / "x.sqlite");
    CHECK(first.take(process(1), false).part == 0);
    first.plan("match", std::vector{kA, kB});
    Ledger second(folder / "x.sqlite");
    const Owner owner = second.take(process(2), true);
    CHECK(owner.token == 2);
    CHECK(owner.part == 1);
    CHECK_THROWS_AS(first.commit(std::vector{event(kA, TileState::done)}), TakenOverError);
    CHECK_THROWS_AS(first.plan("match", std::vector{kC}), TakenOverError);
    CHECK_THROWS_AS(first.set_facts({{"a", "1"}}), TakenOverError);
    record(second, kB, TileState::done);
    const auto tiles = first.tiles("match");
    CHECK(tiles[0].state == TileState::pending);
    CHECK(tiles[1].state == TileState::done);
    CHECK(tiles[1].part == 1);
    CHECK(second.owners().size() == 2);
    CHECK(second.owners()[0].pid == 1);
}

TEST_CASE("attempts that ended are listed with outcome and reason")
{
    const TemporaryFolder folder;
    Ledger ledger(folder / "x.sqlite");
    ledger.take(process(1), false);
    ledger.plan("match", std::vector{kA});
    record(ledger, kA, TileState::pending, "the device was lost");
    record(ledger, kA, TileState::pending); // dropped on request: no attempt that counts
    record(ledger, kA, TileState::done);
    const Contents contents = read_ledger(folder / "x.sqlite");
    REQUIRE(contents.attempts.size() == 2);
    CHECK(contents.attempts[0].outcome == "failed");
    CHECK(contents.attempts[0].reason == "the device was lost");
    CHECK(contents.attempts[0].worker == "cpu 1");
    CHECK(contents.attempts[1].outcome == "done");
    CHECK(contents.attempts[1].seconds == 2.25);
    CHECK(contents.tiles.at(0).attempts == 3);
    CHECK(contents.owners.at(0).program == "hsgm 0");
}

TEST_CASE("a ledger may be read while it is written")
{
    const TemporaryFolder folder;
    Ledger ledger(folder / "x.sqlite");
    ledger.take(process(1), false);
    ledger.plan("match", std::vector{kA, kB});
    for (int i = 0; i < 20; ++i) {
        ledger.commit(std::vector{event(kA, TileState::running)});
        CHECK(read_ledger(folder / "x.sqlite").tiles.at(0).attempts == i + 1);
    }
}

TEST_CASE("names of states can be read back")
{
    for (const TileState state :
         {TileState::pending, TileState::running, TileState::done, TileState::failed}) {
        CHECK(state_from_name(name(state)) == state);
    }
    CHECK_THROWS_AS(state_from_name("lost"), std::invalid_argument);
}
