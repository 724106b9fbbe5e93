#pragma once

#include "tiling/image.h"

#include <array>
#include <cstdint>
#include <string>

namespace hsgm::io {

/// Red, green and blue.
using Rgb = std::array<std::uint8_t, 3>;

/// Writes a picture for people, whole or not at all and without side files. The file is read
/// back before it takes its name. Throws StorageError.
void write_png(const std::string& path, tiling::ImageView<const std::uint8_t> gray);
void write_png(const std::string& path, tiling::ImageView<const Rgb> pixels);

} // namespace hsgm::io
