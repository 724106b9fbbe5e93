#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace hsgm::io {

/// Bytes that are free for us on the disk of a file or folder, which need not be there yet:
/// then of the folder that it would lie in. Nothing where the system does not tell.
std::optional<std::int64_t> free_bytes(const std::filesystem::path& path);

/// Bytes that the files below a folder take on the disk; 0 where there is none.
std::int64_t bytes_taken(const std::filesystem::path& folder);

} // namespace hsgm::io
