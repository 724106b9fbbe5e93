#include "pipeline/ledger/file_lock.h"

#include "io/error.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace hsgm::ledger {

namespace {

struct flock whole_file()
{
    struct flock range {};
    range.l_type = F_WRLCK;
    range.l_whence = SEEK_SET;
    return range;
}

// Belongs to the open file, not to the process: closing another handle of the same file does
// not give it up, and two holders in one process exclude each other.
bool try_lock(int fd)
{
    struct flock range = whole_file();
    while (::fcntl(fd, F_OFD_SETLK, &range) != 0) {
        if (errno == EAGAIN || errno == EACCES) {
            return false;
        }
        if (errno != EINTR) {
            throw std::system_error(errno, std::generic_category());
        }
    }
    return true;
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& words)
{
    throw io::StorageError("Cannot lock " + path.string() + ": " + words +
                           "; name an output folder that is writable and on a file system "
                           "with locks.");
}

} // namespace

std::optional<FileLock> FileLock::take(const std::filesystem::path& path,
                                       const std::string& holder)
{
    FileLock lock(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (lock.fd_ < 0) {
        fail(path, std::generic_category().message(errno));
    }
    try {
        if (!try_lock(lock.fd_)) {
            return std::nullopt;
        }
    } catch (const std::system_error& error) {
        fail(path, error.code().message());
    }
    // Only for messages: a full disk is no reason to refuse the lock.
    if (::ftruncate(lock.fd_, 0) != 0 ||
        ::pwrite(lock.fd_, holder.data(), holder.size(), 0) < 0) {
        return lock;
    }
    return lock;
}

std::string FileLock::holder(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

bool FileLock::is_held(const std::filesystem::path& path)
{
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        return false;
    }
    struct flock range = whole_file();
    range.l_type = F_RDLCK; // all that a handle for reading may ask for
    const bool held = ::fcntl(fd, F_OFD_GETLK, &range) == 0 && range.l_type != F_UNLCK;
    ::close(fd);
    return held;
}

FileLock::~FileLock()
{
    if (fd_ >= 0) {
        ::close(fd_);
    }
}

FileLock::FileLock(FileLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

FileLock& FileLock::operator=(FileLock&& other) noexcept
{
    std::swap(fd_, other.fd_);
    return *this;
}

} // namespace hsgm::ledger
