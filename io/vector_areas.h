#pragma once

#include <array>
#include <string>
#include <vector>

namespace hsgm::io {

/// The polygons of a vector file. Inside is what an odd number of rings surrounds.
struct VectorAreas {
    /// Corners as (x, y): east and north, or longitude and latitude, whatever the order of
    /// axes in the reference system. Closed: the last corner is joined to the first.
    std::vector<std::vector<std::array<double, 2>>> rings;
    std::string wkt; ///< of the coordinates; empty: the file does not say
};

/// Reads all polygons of the first layer of a file that has any (of GeoPackage, GeoJSON,
/// Shapefile, GML or whatever else GDAL reads); curves become lines. Throws InputError for a
/// file that cannot be read or holds no polygon.
VectorAreas read_areas(const std::string& path);

} // namespace hsgm::io
