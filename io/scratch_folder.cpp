#include "io/scratch_folder.h"

#include "io/error.h"

#include <stdlib.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace hsgm::io {

ScratchFolder::ScratchFolder(const std::filesystem::path& parent)
{
    std::string name = (parent / ".hsgm-scratch-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
        throw StorageError("Cannot make a scratch folder in " + parent.string() + ": " +
                           std::generic_category().message(errno) +
                           "; name a folder that is there and writable.");
    }
    path_ = name;
}

ScratchFolder::~ScratchFolder()
{
    if (!path_.empty()) {
        // A destructor has nobody to tell; what stays is hidden and named after us.
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
}

ScratchFolder::ScratchFolder(ScratchFolder&& other) noexcept
    : path_(std::exchange(other.path_, {}))
{
}

} // namespace hsgm::io
