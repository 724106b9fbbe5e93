#pragma once

#include "tests/unit/io/sample_rasters.h"

#include <sys/mount.h>

#include <iostream>
#include <string>

namespace hsgm::tests {

/// A disk of its own, of 1 MiB or as asked. Needs root's rights; `mounted()` says whether it
/// had them.
class SmallDisk {
public:
    explicit SmallDisk(int size_mib = 1) : size_("size=" + std::to_string(size_mib) + "m")
    {
        mounted_ = ::mount("tmpfs", folder_.path().c_str(), "tmpfs", 0, size_.c_str()) == 0;
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
                        size_.c_str()) == 0);
    }
    const io::samples::TemporaryFolder& folder() const { return folder_; }

private:
    io::samples::TemporaryFolder folder_;
    std::string size_;
    bool mounted_ = false;
};

} // namespace hsgm::tests
