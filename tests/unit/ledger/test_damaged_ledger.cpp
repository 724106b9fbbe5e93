#include "pipeline/ledger/ledger.h"
#include "tests/unit/io/sample_rasters.h"

#include "tests/catch.h"

#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>

using namespace hsgm::ledger;
using Catch::Matchers::Contains;
using hsgm::io::samples::bytes_of_file;
using hsgm::io::samples::put_bytes;
using hsgm::io::samples::TemporaryFolder;
using hsgm::tiling::Rect;

namespace {

std::vector<Rect> many_tiles()
{
    std::vector<Rect> tiles;
    for (int i = 0; i < 2000; ++i) {
        tiles.push_back({i / 50 * 64, i % 50 * 64, 64, 64});
    }
    return tiles;
}

void write_ledger(const std::string& path)
{
    Ledger ledger(path);
    ledger.take({}, false);
    ledger.plan("match", many_tiles());
}

} // namespace

TEST_CASE("a ledger cut short is noticed wherever it is cut")
{
    const TemporaryFolder folder;
    write_ledger(folder / "x.sqlite");
    const std::string whole = bytes_of_file(folder / "x.sqlite");
    REQUIRE(whole.size() > 40'000);
    for (const std::size_t length : {std::size_t{50}, std::size_t{4096}, std::size_t{10'000},
                                     whole.size() / 2, whole.size() - 4096, whole.size() - 1}) {
        INFO(length << " of " << whole.size() << " bytes");
        put_bytes(folder / "cut.sqlite", whole.substr(0, length));
        CHECK_THROWS_AS(Ledger(folder / "cut.sqlite"), DamagedError);
    }
    put_bytes(folder / "empty.sqlite", "");
    CHECK(Ledger(folder / "empty.sqlite").tiles("match").empty());
}

TEST_CASE("files that are no ledger are refused by name")
{
    const TemporaryFolder folder;
    put_bytes(folder / "text.sqlite", std::string(5000, 't'));
    CHECK_THROWS_WITH(Ledger(folder / "text.sqlite"),
                      Contains("text.sqlite is damaged") && Contains("not a database"));
    sqlite3* other = nullptr;
    REQUIRE(sqlite3_open((folder / "other.sqlite").c_str(), &other) == SQLITE_OK);
    sqlite3_exec(other, "CREATE TABLE apples(n INTEGER)", nullptr, nullptr, nullptr);
    sqlite3_close(other);
    CHECK_THROWS_WITH(Ledger(folder / "other.sqlite"), Contains("no ledger of hsgm"));
    CHECK_THROWS_AS(read_ledger(folder / "nothing.sqlite"), hsgm::io::StorageError);
    CHECK_FALSE(std::filesystem::exists(folder / "nothing.sqlite"));
}

TEST_CASE("a ledger of another version is refused with both versions")
{
    const TemporaryFolder folder;
    write_ledger(folder / "x.sqlite");
    sqlite3* database = nullptr;
    REQUIRE(sqlite3_open((folder / "x.sqlite").c_str(), &database) == SQLITE_OK);
    sqlite3_exec(database, "PRAGMA user_version = 7", nullptr, nullptr, nullptr);
    sqlite3_close(database);
    CHECK_THROWS_AS(Ledger(folder / "x.sqlite"), VersionError);
    CHECK_THROWS_WITH(read_ledger(folder / "x.sqlite"),
                      Contains("layout 7, this one knows 1") && Contains("--restart"));
}

TEST_CASE("a process killed in mid-commit leaves a ledger of some whole commits")
{
    const TemporaryFolder folder;
    const std::string path = folder / "x.sqlite";
    write_ledger(path);
    std::size_t last = 0;
    for (int kill = 0; kill < 8; ++kill) {
        const pid_t child = ::fork();
        REQUIRE(child >= 0);
        if (child == 0) {
            Ledger ledger(path);
            ledger.take({}, false);
            for (const Rect& tile : many_tiles()) {
                // Both or none of the two.
                TileEvent first{"match", tile, TileState::done, "a", 0, 0, "", ""};
                TileEvent second = first;
                second.rect.rows = 65; // no such tile: only the attempt is recorded
                ledger.commit(std::vector{first, second});
            }
            ::_exit(0);
        }
        ::usleep(static_cast<useconds_t>(20'000 + 7'000 * kill));
        ::kill(child, SIGKILL);
        ::waitpid(child, nullptr, 0);
        const Contents contents = read_ledger(path);
        const Ledger ledger(path);
        CHECK(contents.tiles.size() == many_tiles().size());
        CHECK(contents.attempts.size() % 2 == 0);
        CHECK(contents.attempts.size() >= last);
        last = contents.attempts.size();
    }
    CHECK(last > 0);
}
