#pragma once

#include <array>
#include <optional>
#include <string>

namespace hsgm::io {

/// Which pixels to read, as a configuration states it.
struct ImageSpec {
    /// Any path that GDAL opens, `/vsizip/`, `/vsicurl/` and the like included.
    std::string path;
    /// Counted from 1. 0 chooses: luminance where the first three bands are red, green and
    /// blue in 8 or 16 bits, else band 1.
    int band = 0;
    /// The value that means "no value"; replaces the one that the file declares. NaN here
    /// switches the declared one off.
    std::optional<double> nodata = std::nullopt;
    /// A raster file of the same size whose zeros mark pixels without a value, or a vector file
    /// whose polygons do: in pixels where it has no reference system, else on the map. May be
    /// empty.
    std::string mask = "";
    /// A file with the image's camera model; empty: what the image carries or lies beside it.
    std::string rpc = "";
    /// Of orthoimages: azimuth of the satellite as seen from the ground, clockwise from north,
    /// and its angle from the zenith, in degrees.
    std::optional<std::array<double, 2>> view_deg = std::nullopt;
    /// Or how far a ray moves on the map per metre up, east and north, in metres.
    std::optional<std::array<double, 2>> view_vector = std::nullopt;
};

} // namespace hsgm::io
