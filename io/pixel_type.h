#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace hsgm::io {

/// How a raster file stores its pixels. Complex and 64-bit integer rasters have no place
/// in this program, so they have no name here.
enum class PixelType { uint8, uint16, int16, uint32, int32, float32, float64 };

/// The name that messages and reports use, for example "uint16".
const char* name_of(PixelType type);

/// Bytes of one pixel.
std::size_t bytes_of(PixelType type);

/// True for float32 and float64.
inline bool is_floating(PixelType type)
{
    return type == PixelType::float32 || type == PixelType::float64;
}

/// The pixel type that stores a C++ type exactly; other types do not compile.
template <typename T>
constexpr PixelType pixel_type_of()
{
    if constexpr (std::is_same_v<T, std::uint8_t>) {
        return PixelType::uint8;
    } else if constexpr (std::is_same_v<T, std::uint16_t>) {
        return PixelType::uint16;
    } else if constexpr (std::is_same_v<T, std::int16_t>) {
        return PixelType::int16;
    } else if constexpr (std::is_same_v<T, std::uint32_t>) {
        return PixelType::uint32;
    } else if constexpr (std::is_same_v<T, std::int32_t>) {
        return PixelType::int32;
    } else if constexpr (std::is_same_v<T, float>) {
        return PixelType::float32;
    } else {
        static_assert(std::is_same_v<T, double>, "no raster stores this type");
        return PixelType::float64;
    }
}

} // namespace hsgm::io
