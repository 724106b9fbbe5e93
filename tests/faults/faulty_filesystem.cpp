#include "tests/faults/faulty_filesystem.h"

#include <cpl_vsi_virtual.h>

#include <algorithm>
#include <cerrno>
#include <mutex>
#include <utility>

namespace hsgm::tests {

namespace {

struct Shared {
    std::mutex mutex;
    FaultPlan plan;
    FaultCounts counts;
};

Shared& shared()
{
    static Shared the_one;
    return the_one;
}

/// Counts one event and says whether it is the one that fails.
bool strikes(int FaultCounts::*count, int FaultPlan::*at)
{
    const std::scoped_lock lock(shared().mutex);
    return ++(shared().counts.*count) == shared().plan.*at;
}

std::string behind(const std::string& name)
{
    return name.substr(std::string("/vsifault").size());
}

/// How many of `wanted` bytes the full disk still takes.
std::size_t room_for(std::size_t wanted)
{
    const std::scoped_lock lock(shared().mutex);
    auto allowed = static_cast<std::int64_t>(wanted);
    if (shared().plan.room_bytes >= 0) {
        const std::int64_t left = shared().plan.room_bytes - shared().counts.bytes;
        allowed = std::clamp<std::int64_t>(left, 0, allowed);
    }
    shared().counts.bytes += allowed;
    return static_cast<std::size_t>(allowed);
}

class FaultyHandle final : public VSIVirtualHandle {
public:
    FaultyHandle(VSILFILE* inner, bool writable) : inner_(inner), writable_(writable) {}
    ~FaultyHandle() override
    {
        if (inner_ != nullptr) {
            VSIFCloseL(inner_);
        }
    }

    int Seek(vsi_l_offset offset, int whence) override
    {
        return VSIFSeekL(inner_, offset, whence);
    }
    vsi_l_offset Tell() override { return VSIFTellL(inner_); }
    int Eof() override { return VSIFEofL(inner_); }
    int Flush() override { return VSIFFlushL(inner_); }
    int Truncate(vsi_l_offset size) override { return VSIFTruncateL(inner_, size); }
    std::size_t Read(void* buffer, std::size_t size, std::size_t count) override;
    std::size_t Write(const void* buffer, std::size_t size, std::size_t count) override;
    int Close() override;

private:
    VSILFILE* inner_;
    bool writable_;
};

std::size_t FaultyHandle::Read(void* buffer, std::size_t size, std::size_t count)
{
    if (strikes(&FaultCounts::reads, &FaultPlan::fail_read)) {
        errno = EIO;
        return 0;
    }
    return VSIFReadL(buffer, size, count, inner_);
}

std::size_t FaultyHandle::Write(const void* buffer, std::size_t size, std::size_t count)
{
    if (strikes(&FaultCounts::writes, &FaultPlan::fail_write)) {
        errno = EIO;
        return 0;
    }
    const std::size_t whole = room_for(size * count) / std::max<std::size_t>(size, 1);
    const std::size_t written = VSIFWriteL(buffer, size, whole, inner_);
    if (written < count) {
        errno = ENOSPC; // as write(2) does: what fits is taken, the reason comes with it
    }
    return written;
}

int FaultyHandle::Close()
{
    VSILFILE* closing = std::exchange(inner_, nullptr);
    const int result = closing == nullptr ? 0 : VSIFCloseL(closing);
    if (writable_ && strikes(&FaultCounts::closes, &FaultPlan::fail_close)) {
        errno = EIO;
        return -1;
    }
    return result;
}

/// A C++ handler and not GDAL's plugin of callbacks, because the plugin of GDAL 3.6 hands
/// removals to the operating system instead of to its callback.
class FaultyHandler final : public VSIFilesystemHandler {
public:
    using VSIFilesystemHandler::Open;
    VSIVirtualHandle* Open(const char* name, const char* access, bool, CSLConstList) override;
    int Stat(const char* name, VSIStatBufL* status, int flags) override
    {
        return VSIStatExL(behind(name).c_str(), status, flags);
    }
    int Unlink(const char* name) override { return VSIUnlink(behind(name).c_str()); }
    int Rename(const char* from, const char* to) override;
};

VSIVirtualHandle* FaultyHandler::Open(const char* name, const char* access, bool, CSLConstList)
{
    const bool writable = std::string(access).find_first_of("wa+") != std::string::npos;
    if (writable && strikes(&FaultCounts::opens, &FaultPlan::fail_open)) {
        errno = EACCES;
        return nullptr;
    }
    VSILFILE* file = VSIFOpenL(behind(name).c_str(), access);
    return file == nullptr ? nullptr : new FaultyHandle(file, writable);
}

int FaultyHandler::Rename(const char* from, const char* to)
{
    {
        const std::scoped_lock lock(shared().mutex);
        if (shared().plan.fail_rename) {
            errno = EIO;
            return -1;
        }
    }
    return VSIRename(behind(from).c_str(), behind(to).c_str());
}

void install()
{
    // The file manager owns the handler until the process ends.
    VSIFileManager::InstallHandler("/vsifault/", new FaultyHandler);
}

void set(const FaultPlan& plan)
{
    const std::scoped_lock lock(shared().mutex);
    shared().plan = plan;
    shared().counts = {};
}

} // namespace

FaultyFilesystem::FaultyFilesystem(const FaultPlan& plan)
{
    static std::once_flag once;
    std::call_once(once, install);
    set(plan);
}

FaultyFilesystem::~FaultyFilesystem()
{
    set({});
}

FaultCounts FaultyFilesystem::counts() const
{
    const std::scoped_lock lock(shared().mutex);
    return shared().counts;
}

} // namespace hsgm::tests
