#pragma once

#include <cstdint>
#include <string>

namespace hsgm::tests {

/// What goes wrong below `/vsifault/`, counted from the moment the plan is set. 0 or -1 mean
/// "never"; a fault of a given number strikes once, a full disk stays full.
struct FaultPlan {
    int fail_read = 0;  // the n-th read gives nothing, from 1
    int fail_write = 0; // the n-th write takes nothing and sets EIO
    int fail_open = 0;  // the n-th opening for writing fails with EACCES
    int fail_close = 0; // the n-th closing of a written file fails with EIO
    bool fail_rename = false;
    std::int64_t room_bytes = -1; // so many bytes can be written, then ENOSPC
};

/// How often each thing was asked for since the plan was set.
struct FaultCounts {
    int reads = 0;
    int writes = 0;
    int opens = 0;
    int closes = 0;
    std::int64_t bytes = 0;
};

/// A GDAL file system that passes everything on to the path behind its prefix and fails on
/// demand: `/vsifault/vsimem/x.tif` is `/vsimem/x.tif`, `/vsifault/tmp/x.tif` is
/// `/tmp/x.tif`. One at a time; when it goes, everything works again. Single-threaded plans:
/// counts are kept under a lock, but "the n-th" means little among threads.
class FaultyFilesystem {
public:
    explicit FaultyFilesystem(const FaultPlan& plan = {});
    ~FaultyFilesystem();
    FaultyFilesystem(const FaultyFilesystem&) = delete;
    FaultyFilesystem& operator=(const FaultyFilesystem&) = delete;

    FaultCounts counts() const;
    /// The faulty name of an absolute path.
    static std::string over(const std::string& path) { return "/vsifault" + path; }
};

} // namespace hsgm::tests
