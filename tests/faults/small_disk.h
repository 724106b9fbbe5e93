#pragma once

#include "tests/unit/io/sample_rasters.h"

#include <sys/mount.h>

#include <iostream>

namespace hsgm::tests {

/// A disk of 1 MiB of its own. Needs root's rights; `mounted()` says whether it had them.
class SmallDisk {
public:
    SmallDisk()
    {
        mounted_ = ::mount("tmpfs", folder_.path().c_str(), "tmpfs", 0, "size=1m") == 0;
        if (!mounted_) {
            // ctest looks for these words and reports the test as skipped.
            std::cout << "cannot mount a small disk here: run as root to test full disks\n";
        }
    }
    ~SmallDisk()
    {
        if (mounted_) {
            ::umount2(folder_.path().c_str(), MNT_DETACH);
        }
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

    bool mounted() const { return mounted_; }
    /// Root may write anywhere but to a read-only mount.
    void make_read_only()
    {
        REQUIRE(::mount("tmpfs", folder_.path().c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY,
                        "size=1m") == 0);
    }
    const io::samples::TemporaryFolder& folder() const { return folder_; }

private:
    io::samples::TemporaryFolder folder_;
    bool mounted_ = false;
};

} // namespace hsgm::tests
