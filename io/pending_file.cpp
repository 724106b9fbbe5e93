#include "io/pending_file.h"

#include "io/error.h"
#include "io/gdal_private.h"

#include <cpl_vsi.h>
#include <cpl_vsi_error.h>

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace hsgm::io {

namespace {

std::string folder_of(const std::string& path)
{
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    return folder.empty() ? "." : folder.string();
}

std::string temporary_beginning(const std::filesystem::path& target)
{
    std::string name = ".";
    name += target.stem().string() + ".part-";
    return name;
}

/// ".dsm.part-4711-0.tif" beside "dsm.tif": hidden, on the same disk (a rename never crosses
/// one), with the same ending (some drivers look at it), and one of a kind in this process.
std::string temporary_name(const std::string& path)
{
    static std::atomic<unsigned> counter{0};
    const std::filesystem::path target(path);
    const std::string name = temporary_beginning(target) + std::to_string(::getpid()) + "-" +
                             std::to_string(counter++) + target.extension().string();
    return (target.parent_path() / name).string();
}

std::string system_message(int code)
{
    return std::generic_category().message(code);
}

/// Flushes a file, or a folder after a rename, to the disk. File systems that cannot do that
/// answer EINVAL, which is no failure of ours.
void sync_to_disk(const std::string& path, const std::string& final_path)
{
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    int code = fd < 0 ? errno : 0;
    if (fd >= 0) {
        code = ::fsync(fd) != 0 ? errno : 0;
        ::close(fd);
    }
    if (code != 0 && code != EINVAL && code != ENOTSUP) {
        throw StorageError("Cannot bring " + final_path +
                           " to the disk: " + system_message(code) + ".");
    }
}

void remove_if_there(const std::string& path)
{
    VSIStatBufL status;
    if (VSIStatExL(path.c_str(), &status, VSI_STAT_EXISTS_FLAG) == 0) {
        VSIUnlink(path.c_str());
    }
}

constexpr const char* kSideFiles[] = {".aux.xml", ".ovr", ".msk"};

} // namespace

bool is_virtual_path(const std::string& path)
{
    return path.starts_with("/vsi");
}

PendingFile::PendingFile(std::string final_path)
    : final_path_(std::move(final_path)), temporary_path_(temporary_name(final_path_))
{
    const std::string folder = folder_of(final_path_);
    if (!is_virtual_path(final_path_) && !std::filesystem::is_directory(folder)) {
        throw StorageError("Cannot write " + final_path_ + ": there is no folder " + folder +
                           "; create it or choose another output.");
    }
    if (!is_virtual_path(final_path_) && std::filesystem::is_directory(final_path_)) {
        throw StorageError("Cannot write " + final_path_ + ": it is a folder.");
    }
    ErrorCollector errors;
    VSILFILE* file = VSIFOpenExL(temporary_path_.c_str(), "wb", TRUE);
    if (file == nullptr) {
        const std::string reason = errno != 0 ? system_message(errno) : VSIGetLastErrorMsg();
        throw StorageError("Cannot write " + final_path_ + ": the folder " + folder +
                           " takes no new file (" + reason + "); choose a writable one.");
    }
    VSIFCloseL(file);
}

PendingFile::~PendingFile()
{
    if (!published_) {
        ErrorCollector errors;
        remove_if_there(temporary_path_);
        for (const char* ending : kSideFiles) {
            remove_if_there(temporary_path_ + ending);
        }
    }
}

void PendingFile::publish()
{
    ErrorCollector errors;
    const bool real = !is_virtual_path(final_path_);
    if (real) {
        sync_to_disk(temporary_path_, final_path_);
    }
    errno = 0;
    if (VSIRename(temporary_path_.c_str(), final_path_.c_str()) != 0) {
        throw StorageError("Cannot give " + temporary_path_ + " its final name " + final_path_ +
                           ": " + system_message(errno) + ".");
    }
    published_ = true;
    for (const char* ending : kSideFiles) {
        remove_if_there(final_path_ + ending);
        // GDAL keeps beside a file what its format cannot hold; that travels along.
        VSIStatBufL status;
        if (VSIStatL((temporary_path_ + ending).c_str(), &status) == 0) {
            VSIRename((temporary_path_ + ending).c_str(), (final_path_ + ending).c_str());
        }
    }
    if (real) {
        sync_to_disk(folder_of(final_path_), final_path_);
    }
}

void remove_unpublished(const std::string& final_path)
{
    const std::string beginning = temporary_beginning(final_path);
    std::error_code none;
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder_of(final_path), none)) {
        if (entry.path().filename().string().starts_with(beginning)) {
            found.push_back(entry.path());
        }
    }
    for (const auto& path : found) {
        std::filesystem::remove(path, none);
    }
}

void write_text_file(const std::string& path, std::string_view text)
{
    PendingFile pending(path);
    ErrorCollector errors;
    VSILFILE* file = VSIFOpenExL(pending.temporary_path().c_str(), "wb", TRUE);
    const bool opened = file != nullptr;
    errno = 0;
    const bool written = opened && VSIFWriteL(text.data(), 1, text.size(), file) == text.size();
    const int write_error = errno;
    const bool closed = opened && VSIFCloseL(file) == 0;
    if (!written || !closed) {
        const int code = !written ? write_error : errno;
        throw StorageError("Cannot write " + path + ": " +
                           (code != 0 ? system_message(code) : "the file took no data") + ".");
    }
    pending.publish();
}

} // namespace hsgm::io
