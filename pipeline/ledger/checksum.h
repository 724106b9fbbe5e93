#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace hsgm::ledger {

/// A quick checksum of 64 bits against accidents (lost or torn writes), not against malice:
/// words of eight bytes, the last one filled with zeros, then the length, each mixed in by a
/// product and a shift. The same on every machine of the little-endian kind that hsgm runs on.
/// Pieces may be added one after another; where they are cut makes a difference.
class Checksum {
public:
    void add(std::span<const std::byte> bytes);
    template <typename T>
    void add_values(std::span<const T> values)
    {
        add(std::as_bytes(values));
    }
    /// 16 hexadecimal digits.
    std::string hex() const;

private:
    std::uint64_t state_ = 0x243F6A8885A308D3ULL;
};

/// SHA-256 (FIPS 180-4), for outputs whose checksums other programs shall verify.
class Sha256 {
public:
    Sha256();
    void add(std::span<const std::byte> bytes);
    /// 64 hexadecimal digits. Ends the sum: nothing may be added after it.
    std::string hex();

private:
    void block(const std::byte* bytes);

    std::array<std::uint32_t, 8> state_;
    std::array<std::byte, 64> waiting_{};
    std::uint64_t length_ = 0;
};

/// SHA-256 of a file. Throws StorageError where it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

} // namespace hsgm::ledger
