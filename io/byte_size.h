#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace hsgm::io {

/// The bytes that a text like "8GiB", "512 MiB", "1.5GB" or "4096" means. KiB, MiB, GiB, TiB
/// and the bare K, M, G, T count by 1024, as Slurm does; kB, MB, GB, TB by 1000. Throws
/// ConfigError quoting the text and what is allowed.
std::uint64_t parse_bytes(std::string_view text);

/// An amount of memory or disk: so many bytes, or a share of what the machine has.
struct ByteAmount {
    std::optional<std::uint64_t> bytes;
    double share = 0; // used where `bytes` is empty; above 0, at most 1

    /// In bytes on a machine that has `total_bytes`.
    std::uint64_t of(std::uint64_t total_bytes) const;
    bool operator==(const ByteAmount&) const = default;
};

/// As `parse_bytes`, and also "80%".
ByteAmount parse_byte_amount(std::string_view text);

} // namespace hsgm::io
