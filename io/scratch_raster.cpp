#include "io/scratch_raster.h"

#include "io/error.h"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

namespace hsgm::io {

namespace {

/// Free for us on the disk that holds `path`; nothing known: 0.
std::uint64_t free_bytes(const std::filesystem::path& path)
{
    struct statvfs status {};
    if (::statvfs(path.parent_path().c_str(), &status) != 0) {
        return 0;
    }
    return std::uint64_t{status.f_bavail} * status.f_frsize;
}

/// Reserves without writing. Returns an errno; EOPNOTSUPP where the file system cannot
/// (posix_fallocate would then write the whole file, once more than needed).
int reserve_bytes(int fd, std::int64_t bytes)
{
    while (::fallocate(fd, 0, 0, bytes) != 0) {
        if (errno != EINTR) {
            return errno;
        }
    }
    return 0;
}

bool all_zero(std::span<const std::byte> bytes)
{
    return std::all_of(bytes.begin(), bytes.end(),
                       [](std::byte b) { return b == std::byte{}; });
}

} // namespace

ScratchFile::ScratchFile(const std::filesystem::path& path, std::int64_t bytes,
                         std::span<const std::byte> fill, ScratchLife life)
    : path_(path), keep_(life != ScratchLife::temporary)
{
    if (life == ScratchLife::existing) {
        open_existing(bytes);
    } else {
        make(bytes, fill);
    }
}

void ScratchFile::open_existing(std::int64_t bytes)
{
    fd_ = ::open(path_.c_str(), O_RDWR | O_CLOEXEC);
    if (fd_ < 0) {
        fail("open", errno);
    }
    const off_t length = ::lseek(fd_, 0, SEEK_END);
    if (length != bytes) {
        ::close(fd_);
        throw StorageError("The scratch file " + path_.string() + " has " +
                           std::to_string(length) + " bytes instead of " +
                           std::to_string(bytes) + ": somebody changed it.");
    }
}

void ScratchFile::make(std::int64_t bytes, std::span<const std::byte> fill)
{
    fd_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (fd_ < 0) {
        fail("make", errno);
    }
    try {
        reserve(bytes);
        if (!all_zero(fill)) {
            fill_with(fill, bytes);
        }
    } catch (...) {
        keep_ = false;
        remove(); // a constructor that throws has no destructor to clean up
        throw;
    }
}

ScratchFile::~ScratchFile()
{
    remove();
}

ScratchFile::ScratchFile(ScratchFile&& other) noexcept
    : path_(std::move(other.path_)), keep_(other.keep_), fd_(std::exchange(other.fd_, -1))
{
}

void ScratchFile::remove() noexcept
{
    if (fd_ >= 0) {
        ::close(fd_);
        if (!keep_) {
            ::unlink(path_.c_str());
        }
        fd_ = -1;
    }
}

void ScratchFile::fail(const std::string& what, int code) const
{
    throw StorageError("Cannot " + what + " the scratch file " + path_.string() + ": " +
                       std::generic_category().message(code) + ".");
}

void ScratchFile::reserve(std::int64_t bytes)
{
    if (bytes == 0) {
        return;
    }
    const std::uint64_t free_before = free_bytes(path_);
    int code = reserve_bytes(fd_, bytes);
    if (code == EOPNOTSUPP || code == ENOSYS) {
        // The best that is left: what is free now, though others may take it later.
        const bool fits = free_before >= static_cast<std::uint64_t>(bytes);
        code = !fits ? ENOSPC : (::ftruncate(fd_, bytes) == 0 ? 0 : errno);
    }
    if (code == ENOSPC || code == EDQUOT || code == EFBIG) {
        throw StorageError(
            "The scratch file " + path_.string() + " needs " + std::to_string(bytes) +
            " bytes, but " + std::to_string(free_before) + " are free (" +
            std::generic_category().message(code) + "); free space or name another folder.");
    }
    if (code != 0) {
        fail("reserve room for", code);
    }
}

void ScratchFile::fill_with(std::span<const std::byte> fill, std::int64_t bytes)
{
    constexpr std::size_t kChunkBytes = std::size_t{1} << 20;
    const std::size_t copies = std::max<std::size_t>(kChunkBytes / fill.size(), 1);
    std::vector<std::byte> chunk(copies * fill.size());
    for (std::size_t i = 0; i < copies; ++i) {
        std::memcpy(&chunk[i * fill.size()], fill.data(), fill.size());
    }
    for (std::int64_t offset = 0; offset < bytes;) {
        const auto step =
            std::min<std::int64_t>(static_cast<std::int64_t>(chunk.size()), bytes - offset);
        write(offset, chunk.data(), static_cast<std::size_t>(step));
        offset += step;
    }
}

void ScratchFile::read(std::int64_t offset, std::byte* data, std::size_t bytes) const
{
    while (bytes > 0) {
        const ssize_t n = ::pread(fd_, data, bytes, offset);
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n <= 0) {
            fail("read", n < 0 ? errno : EIO); // its end came early: somebody shortened it
        }
        offset += n;
        data += n;
        bytes -= static_cast<std::size_t>(n);
    }
}

void ScratchFile::sync()
{
    // File systems that cannot do that answer EINVAL, which is no failure of ours.
    if (::fdatasync(fd_) != 0 && errno != EINVAL) {
        fail("bring to the disk", errno);
    }
}

void ScratchFile::write(std::int64_t offset, const std::byte* data, std::size_t bytes)
{
    while (bytes > 0) {
        const ssize_t n = ::pwrite(fd_, data, bytes, offset);
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n < 0) {
            fail("write", errno);
        }
        offset += n;
        data += n;
        bytes -= static_cast<std::size_t>(n);
    }
}

} // namespace hsgm::io
