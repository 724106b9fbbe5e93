#pragma once

#include <string>

namespace hsgm::io {

/// What tells a file from another one without reading it all: its length, and a checksum of its
/// first and last 64 KiB and of 64 pieces between, as "1234 bytes, checksum 00ff...".
/// Understands GDAL's virtual paths. Throws InputError where it cannot be read.
std::string identity_of_file(const std::string& path);

} // namespace hsgm::io
