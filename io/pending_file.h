#pragma once

#include <string>
#include <string_view>

namespace hsgm::io {

/// An output that appears under its final name only when it is whole. Write to
/// `temporary_path()`, a hidden file in the same folder; `publish()` moves it over the final
/// name in one step; a PendingFile that dies unpublished removes what was written and leaves
/// an earlier output as it was.
class PendingFile {
public:
    /// Throws StorageError where the folder is missing or takes no new file. Understands
    /// GDAL's virtual paths, such as `/vsimem/`.
    explicit PendingFile(std::string final_path);
    ~PendingFile();
    PendingFile(const PendingFile&) = delete;
    PendingFile& operator=(const PendingFile&) = delete;

    const std::string& final_path() const { return final_path_; }
    const std::string& temporary_path() const { return temporary_path_; }

    /// Waits until the disk has the bytes, then renames. Removes side files of the output
    /// that it replaces (statistics, overviews, masks), for they describe other pixels.
    /// Throws StorageError, and then the earlier output is still there.
    void publish();

private:
    std::string final_path_;
    std::string temporary_path_;
    bool published_ = false;
};

/// Removes hidden files that processes which were killed left of this output. Only where no
/// process is writing it.
void remove_unpublished(const std::string& final_path);

/// Writes a small text file whole or not at all. Throws StorageError.
void write_text_file(const std::string& path, std::string_view text);

/// True for GDAL's virtual paths, which the operating system does not know.
bool is_virtual_path(const std::string& path);

} // namespace hsgm::io
