#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace hsgm::ledger {

/// An advisory lock on a file, held until it is destroyed or the process ends, however that
/// comes about: a dead process blocks nobody. Works across hosts where the file system's locks
/// do. The file stays; deleting it would let two holders have a lock each.
class FileLock {
public:
    /// Nothing where another holder has the lock. `holder` is written into the file, for
    /// messages. Throws StorageError where the folder takes no file, or knows no locks.
    static std::optional<FileLock> take(const std::filesystem::path& path,
                                        const std::string& holder);
    /// What the last holder wrote; empty where there was none.
    static std::string holder(const std::filesystem::path& path);
    /// Whether someone has it now. Makes no file.
    static bool is_held(const std::filesystem::path& path);

    ~FileLock();
    FileLock(FileLock&& other) noexcept;
    FileLock& operator=(FileLock&& other) noexcept;

private:
    explicit FileLock(int fd) : fd_(fd) {}
    int fd_ = -1;
};

} // namespace hsgm::ledger
