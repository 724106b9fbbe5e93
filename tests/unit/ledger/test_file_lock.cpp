#include "io/error.h"
#include "pipeline/ledger/file_lock.h"
#include "tests/unit/io/sample_rasters.h"

#include "tests/catch.h"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

using namespace hsgm::ledger;
using hsgm::io::samples::TemporaryFolder;

TEST_CASE("a lock has one holder at a time")
{
    const TemporaryFolder folder;
    const std::string path = folder / "x.lock";
    CHECK_FALSE(FileLock::is_held(path));
    {
        const auto first = FileLock::take(path, "process 12 on here");
        REQUIRE(first.has_value());
        CHECK_FALSE(FileLock::take(path, "another").has_value());
        CHECK(FileLock::holder(path) == "process 12 on here");
        CHECK(FileLock::is_held(path));
    }
    CHECK_FALSE(FileLock::is_held(path));
    CHECK(FileLock::take(path, "another").has_value());
    CHECK(FileLock::holder(path) == "another");
}

TEST_CASE("a process that is killed leaves no lock")
{
    const TemporaryFolder folder;
    const std::string path = folder / "x.lock";
    int pipe_ends[2];
    REQUIRE(::pipe(pipe_ends) == 0);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        const auto held = FileLock::take(path, "child");
        const char ready = held ? 'y' : 'n';
        while (::write(pipe_ends[1], &ready, 1) == 1) {
            ::pause();
        }
        ::_exit(1);
    }
    char ready = 0;
    REQUIRE(::read(pipe_ends[0], &ready, 1) == 1);
    CHECK(ready == 'y');
    CHECK_FALSE(FileLock::take(path, "parent").has_value());
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    CHECK(FileLock::take(path, "parent").has_value());
    ::close(pipe_ends[0]);
    ::close(pipe_ends[1]);
}

TEST_CASE("a lock that cannot be made is an error of storage")
{
    const TemporaryFolder folder;
    CHECK_THROWS_AS(FileLock::take(folder / "nowhere/x.lock", "me"), hsgm::io::StorageError);
    CHECK_THROWS_WITH(FileLock::take(folder / "nowhere/x.lock", "me"),
                      Catch::Matchers::Contains("Cannot lock") &&
                          Catch::Matchers::Contains("writable"));
}
