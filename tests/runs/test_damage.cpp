#include "tests/runs/run_place.h"

#include "tests/catch.h"

#include <sqlite3.h>

#include <filesystem>

using namespace hsgm;
using namespace hsgm::tests;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

struct Unfinished {
    RunPlace place = slow_place();
    Unfinished() { REQUIRE(place.run_and_kill(5) >= 5); }

    std::string ledger() const { return place.result() + "/ledger/tiles-0-of-1.sqlite"; }
    std::string part(const char* name) const
    {
        return fs::path(place.result()) / "work" / "tiles-0-of-1" / "0" / name;
    }
    void resumes_to_the_same(const std::string& words) const
    {
        const Outcome outcome = place.run_to(0, {"--resume"});
        CHECK_THAT(outcome.err, Contains(words));
        CHECK((place.rasters() == place.undisturbed()));
    }
};

void change(const std::string& database, const char* sql)
{
    sqlite3* handle = nullptr;
    REQUIRE(sqlite3_open(database.c_str(), &handle) == SQLITE_OK);
    CHECK(sqlite3_exec(handle, sql, nullptr, nullptr, nullptr) == SQLITE_OK);
    sqlite3_close(handle);
}

} // namespace

TEST_CASE("a ledger cut short is set aside and its tiles are matched again")
{
    const Unfinished run;
    fs::resize_file(run.ledger(), fs::file_size(run.ledger()) / 2);
    run.resumes_to_the_same("is set aside as tiles-0-of-1.sqlite.damaged");
    CHECK(fs::exists(run.ledger() + ".damaged"));
}

TEST_CASE("the ledger of the coarse stage may be lost")
{
    const Unfinished run;
    const std::string coarse = run.place.result() + "/ledger/coarse.sqlite";
    fs::resize_file(coarse, 100);
    run.resumes_to_the_same("is set aside as coarse.sqlite.damaged");
}

TEST_CASE("stored results that have changed are matched again")
{
    const Unfinished run;
    const std::string bytes = io::samples::bytes_of_file(run.part("disparity.raw"));
    std::string spoilt = bytes;
    spoilt[1000] = static_cast<char>(spoilt[1000] ^ 1);
    put_bytes(run.part("disparity.raw"), spoilt);
    run.resumes_to_the_same("stored results of 1 tiles do not have their checksums");
}

TEST_CASE("stored results that were cut short or deleted are matched again")
{
    for (const bool whole_folder : {false, true}) {
        const Unfinished run;
        if (whole_folder) {
            fs::remove_all(run.place.result() + "/work");
        } else {
            fs::resize_file(run.part("right_keys.raw"), 1000);
        }
        run.resumes_to_the_same("do not have their checksums");
    }
}

TEST_CASE("a ledger of another version is refused with what to do")
{
    const Unfinished run;
    change(run.ledger(), "PRAGMA user_version = 9");
    const Outcome refused = run.place.run_to(2, {"--resume"});
    CHECK_THAT(refused.err, Contains("another version of hsgm") && Contains("--restart"));
    run.place.run_to(0, {"--restart"});
    CHECK((run.place.rasters() == run.place.undisturbed()));
}

TEST_CASE("a run begun by another version of the program is not resumed")
{
    const Unfinished run;
    change(run.place.result() + "/ledger/coarse.sqlite",
           "UPDATE facts SET value = 'hsgm 0.0.1' WHERE name = 'defines: program'");
    const Outcome refused = run.place.run_to(2, {"--resume"});
    CHECK_THAT(refused.err, Contains("program: hsgm 0.0.1 before, hsgm "));
}

TEST_CASE("a clock that was set back between two attempts changes nothing")
{
    const Unfinished run;
    for (const std::string& ledger :
         {run.ledger(), run.place.result() + "/ledger/coarse.sqlite"}) {
        change(ledger, "UPDATE tiles SET started_s = started_s + 1e9;"
                       "UPDATE attempts SET started_s = started_s + 1e9;"
                       "UPDATE owners SET started_s = started_s + 1e9");
    }
    run.resumes_to_the_same("resuming");
}

TEST_CASE("an unpublished file of a killed process does not stay")
{
    const Unfinished run;
    put_bytes(run.place.result() + "/.disparity.part-123-0.tif", "half a file");
    run.resumes_to_the_same("resuming");
    CHECK_FALSE(fs::exists(run.place.result() + "/.disparity.part-123-0.tif"));
}
