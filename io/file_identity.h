#pragma once

#include <span>
#include <string>

namespace hsgm::io {

/// What tells a file from another one, whatever their names and times: its length and a
/// checksum of all its bytes, as "1234 bytes, checksum 00ff...". Understands GDAL's virtual
/// paths. Throws InputError where it cannot be read.
std::string identity_of_file(const std::string& path);

/// What the file system tells of files without reading them: length, place, and when they were
/// last changed, to the nanosecond. The same stamp: nobody has touched them since. Another one:
/// they may or may not have other bytes. Empty where that cannot be told, as of a file behind
/// a virtual path.
std::string stamp_of_files(std::span<const std::string> paths);

} // namespace hsgm::io
