#include "io/disk_room.h"

#include <sys/stat.h>

#include <system_error>

namespace hsgm::io {

std::optional<std::int64_t> free_bytes(const std::filesystem::path& path)
{
    std::error_code error;
    std::filesystem::path place = std::filesystem::absolute(path, error);
    while (!std::filesystem::exists(place, error) && place.has_relative_path()) {
        place = place.parent_path();
    }
    const auto space = std::filesystem::space(place, error);
    return error ? std::nullopt : std::optional(static_cast<std::int64_t>(space.available));
}

std::int64_t bytes_taken(const std::filesystem::path& folder)
{
    std::int64_t sum = 0;
    std::error_code error;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, error)) {
        struct stat status {};
        if (::stat(entry.path().c_str(), &status) == 0 && S_ISREG(status.st_mode)) {
            sum += std::int64_t{status.st_blocks} * 512;
        }
    }
    return sum;
}

} // namespace hsgm::io
