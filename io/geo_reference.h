#pragma once

#include <array>
#include <optional>
#include <string>

namespace hsgm::io {

/// Where a raster lies on the ground, as GDAL stores it.
struct GeoReference {
    /// Ground from pixel *corner* coordinates (GDAL's order):
    ///     x = t[0] + col * t[1] + row * t[2],   y = t[3] + col * t[4] + row * t[5]
    /// Absent where the file has none.
    std::optional<std::array<double, 6>> transform;
    /// The coordinate reference system as WKT (any version is understood when written, WKT2
    /// is given when read); empty where unknown.
    std::string wkt;

    bool operator==(const GeoReference&) const = default;
};

} // namespace hsgm::io
