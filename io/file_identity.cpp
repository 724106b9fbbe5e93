#include "io/file_identity.h"

#include "io/error.h"
#include "io/gdal_private.h"

#include <cpl_vsi.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hsgm::io {

namespace {

constexpr std::int64_t kEndBytes = 64 << 10;
constexpr std::int64_t kPieceBytes = 4 << 10;
constexpr std::int64_t kPieces = 64;

struct CloseFile {
    void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};
using File = std::unique_ptr<VSILFILE, CloseFile>;

std::int64_t length_of(VSILFILE* file)
{
    VSIFSeekL(file, 0, SEEK_END);
    return static_cast<std::int64_t>(VSIFTellL(file));
}

// FNV-1a, byte by byte: a few hundred KiB at most.
void add(std::span<const unsigned char> bytes, std::uint64_t& sum)
{
    for (const unsigned char byte : bytes) {
        sum = (sum ^ byte) * 0x100000001B3ULL;
    }
}

std::string hex(std::uint64_t sum)
{
    std::string text;
    for (int shift = 60; shift >= 0; shift -= 4) {
        text += "0123456789abcdef"[sum >> shift & 15];
    }
    return text;
}

} // namespace

std::string identity_of_file(const std::string& path)
{
    ErrorCollector errors;
    const File file(VSIFOpenL(path.c_str(), "rb"));
    if (file == nullptr) {
        throw InputError("Cannot read " + path + "; " + errors.quote() + ".");
    }
    const std::int64_t length = length_of(file.get());
    std::uint64_t sum = 0xCBF29CE484222325ULL;
    std::vector<unsigned char> bytes(static_cast<std::size_t>(kEndBytes));
    const auto add_piece = [&](std::int64_t offset, std::int64_t wanted) {
        const auto size =
            static_cast<std::size_t>(std::clamp<std::int64_t>(length - offset, 0, wanted));
        VSIFSeekL(file.get(), static_cast<vsi_l_offset>(offset), SEEK_SET);
        if (VSIFReadL(bytes.data(), 1, size, file.get()) != size) {
            throw InputError("Cannot read " + path + " at byte " + std::to_string(offset) +
                             "; " + errors.quote() + ".");
        }
        add(std::span(bytes).first(size), sum);
    };
    add_piece(0, kEndBytes);
    for (std::int64_t i = 1; i <= kPieces && length > 2 * kEndBytes; ++i) {
        add_piece(length / (kPieces + 1) * i, kPieceBytes);
    }
    add_piece(std::max<std::int64_t>(length - kEndBytes, 0), kEndBytes);
    return std::to_string(length) + " bytes, checksum " + hex(sum);
}

} // namespace hsgm::io
