#include "io/error.h"
#include "io/file_identity.h"

#include "tests/catch.h"
#include "tests/unit/io/sample_rasters.h"

#include <chrono>
#include <filesystem>
#include <string>

using namespace hsgm::io;
using samples::put_bytes;
using samples::TemporaryFolder;
namespace fs = std::filesystem;

TEST_CASE("the identity of a file is its bytes, all of them")
{
    const TemporaryFolder folder;
    std::string bytes(3'000'000, 'a');
    put_bytes(folder / "one", bytes);
    put_bytes(folder / "copy", bytes);
    CHECK(identity_of_file(folder / "one") == identity_of_file(folder / "copy"));
    CHECK(identity_of_file(folder / "one").starts_with("3000000 bytes, checksum "));
    for (const std::size_t place : {0UL, 1'500'001UL, 2'999'999UL}) {
        std::string changed = bytes;
        changed[place] = 'b';
        put_bytes(folder / "copy", changed);
        INFO(place);
        CHECK(identity_of_file(folder / "one") != identity_of_file(folder / "copy"));
    }
    put_bytes(folder / "copy", bytes + "a");
    CHECK(identity_of_file(folder / "one") != identity_of_file(folder / "copy"));
    CHECK_THROWS_AS(identity_of_file(folder / "absent"), InputError);
}

TEST_CASE("the stamp of files changes with every touch, even where the time is put back")
{
    const TemporaryFolder folder;
    put_bytes(folder / "a", "1234");
    put_bytes(folder / "b", "5678");
    const std::vector<std::string> files{folder / "a", folder / "b"};
    const std::string stamp = stamp_of_files(files);
    CHECK_FALSE(stamp.empty());
    CHECK(stamp_of_files(files) == stamp);
    const auto time = fs::last_write_time(folder / "b");
    put_bytes(folder / "b", "5679");
    fs::last_write_time(folder / "b", time);
    CHECK(stamp_of_files(files) != stamp);
}

TEST_CASE("files that the file system does not know have no stamp")
{
    const TemporaryFolder folder;
    put_bytes(folder / "a", "1234");
    CHECK(stamp_of_files(std::vector<std::string>{folder / "a", "/vsimem/none"}).empty());
}
