#include "tests/faults/small_disk.h"
#include "tests/refusals/earlier_result.h"

#include "tests/catch.h"

using namespace hsgm::tests;

namespace {

// A good pair on an ordinary disk, and results of it on a small one.
class OnSmallDisk {
public:
    explicit OnSmallDisk(const SmallDisk& disk) : disk_(disk)
    {
        make_pair(images_);
        const Outcome outcome = match(images_, {});
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        before_ = files();
    }

    /// Matches another pair into the same outputs: code 6, a sentence, nothing changed.
    void refused(hsgm::tiling::Size size, const std::vector<std::string>& options,
                 const std::vector<std::string>& words) const
    {
        const TemporaryFolder larger;
        make_pair(larger, size);
        const Outcome outcome = match(larger, options);
        INFO(outcome.err);
        CHECK(outcome.code == 6);
        for (const std::string& word : words) {
            CHECK_THAT(outcome.err, Catch::Matchers::Contains(word));
        }
        CHECK((files() == before_));
    }

private:
    Snapshot files() const { return snapshot(disk_.folder().path().string()); }
    Outcome match(const TemporaryFolder& pair, const std::vector<std::string>& options) const
    {
        std::vector<std::string> all{"match",
                                     pair / "left.tif",
                                     pair / "right.tif",
                                     "-o",
                                     disk_.folder() / "d.tif",
                                     "--disparity",
                                     "0,10",
                                     "--tile-size",
                                     "64"};
        all.insert(all.end(), options.begin(), options.end());
        return run_hsgm(all);
    }

    const SmallDisk& disk_;
    TemporaryFolder images_;
    Snapshot before_;
};

} // namespace

TEST_CASE("a disk too small for the scratch files is refused before the first tile")
{
    SmallDisk disk;
    if (!disk.mounted()) {
        return;
    }
    const OnSmallDisk results(disk);
    results.refused({400, 400}, {},
                    {"needs", "between its stages", "of results at most", "are free",
                     "name another output"});
}

TEST_CASE("a disk that may not be written to is refused before the first tile")
{
    SmallDisk disk;
    if (!disk.mounted()) {
        return;
    }
    const OnSmallDisk results(disk);
    disk.make_read_only();
    results.refused({60, 90}, {}, {"scratch folder", "Read-only file system", "writable"});
    const TemporaryFolder other;
    make_pair(other);
    put_bytes(other / "run.yaml", pair_config());
    for (const std::string folder : {"", "new"}) {
        const Outcome outcome =
            run_hsgm({"run", other / "run.yaml", "-o", disk.folder() / folder});
        CHECK(outcome.code == 6);
        CHECK_THAT(outcome.err, Catch::Matchers::Contains("Read-only file system"));
    }
}
