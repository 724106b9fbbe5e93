#pragma once

#include <filesystem>
#include <string>

namespace hsgm::io {

/// A hidden folder for intermediate files, `.hsgm-scratch-XXXXXX`, of a name that no other
/// run has. Goes away with its content when it is destroyed, also while an exception flies;
/// only a killed process leaves one behind.
class ScratchFolder {
public:
    /// Makes the folder inside `parent`, usually the output's folder: the same disk, whose
    /// room the plan has counted. Throws StorageError.
    explicit ScratchFolder(const std::filesystem::path& parent);
    ~ScratchFolder();
    ScratchFolder(ScratchFolder&& other) noexcept;
    ScratchFolder& operator=(ScratchFolder&&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_; // empty: moved from
};

} // namespace hsgm::io
