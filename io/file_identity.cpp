#include "io/file_identity.h"

#include "io/error.h"
#include "io/gdal_private.h"

#include <cpl_vsi.h>
#include <sys/stat.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hsgm::io {

namespace {

constexpr std::size_t kPieceBytes = 1 << 20;

struct CloseFile {
    void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};
using File = std::unique_ptr<VSILFILE, CloseFile>;

// FNV-1a (Fowler, Noll, Vo), byte by byte: such files are small beside images.
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
    std::uint64_t sum = 0xCBF29CE484222325ULL;
    std::uint64_t length = 0;
    std::vector<unsigned char> bytes(kPieceBytes);
    while (true) {
        const std::size_t count = VSIFReadL(bytes.data(), 1, bytes.size(), file.get());
        add(std::span(bytes).first(count), sum);
        length += count;
        if (count < bytes.size()) {
            break;
        }
    }
    if (VSIFEofL(file.get()) == 0 || errors.failed()) {
        throw InputError("Cannot read " + path + " at byte " + std::to_string(length) + "; " +
                         errors.quote() + ".");
    }
    return std::to_string(length) + " bytes, checksum " + hex(sum);
}

std::string stamp_of_files(std::span<const std::string> paths)
{
    std::string stamp;
    for (const std::string& path : paths) {
        struct stat seen = {};
        if (::stat(path.c_str(), &seen) != 0) {
            return "";
        }
        for (const std::int64_t number :
             {std::int64_t(seen.st_size), std::int64_t(seen.st_dev), std::int64_t(seen.st_ino),
              std::int64_t(seen.st_mtim.tv_sec), std::int64_t(seen.st_mtim.tv_nsec),
              std::int64_t(seen.st_ctim.tv_sec), std::int64_t(seen.st_ctim.tv_nsec)}) {
            stamp += std::to_string(number) + ' ';
        }
    }
    return stamp;
}

} // namespace hsgm::io
