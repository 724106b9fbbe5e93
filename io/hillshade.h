#pragma once

#include "tiling/rect.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace hsgm::io {

/// How a shaded relief is lit.
struct HillshadeOptions {
    /// Where the light comes from, clockwise from north; north is the top of a raster
    /// without georeference.
    double azimuth_deg = 315;
    /// Height of the light above the horizon, 0 to 90.
    double altitude_deg = 45;
    /// Exaggerates heights; above 0.
    double z_factor = 1;
    /// Ground units per height unit: 1 on a metric grid, about 111120 for degrees and metres.
    double scale = 1;
    /// `KEY=VALUE`, as in RasterOptions.
    std::vector<std::string> creation_options = {};

    /// Throws ConfigError naming the value and what is allowed.
    void validate() const;
};

/// Shades a height raster into a GeoTIFF of 8 bits, 1 to 255, 0 where there is no height, by
/// GDAL's gdaldem. Takes its final name when whole. Throws InputError for an unreadable
/// height file, StorageError where the output cannot be written. `go_on` is asked now and then;
/// where it says no, nothing is written and the answer is false.
bool write_hillshade(const std::string& height_path, const std::string& output_path,
                     const HillshadeOptions& options = {},
                     const std::function<bool()>& go_on = {});

/// GDAL's block cache while it shades a raster of that size.
std::int64_t hillshade_bytes(tiling::Size size);

} // namespace hsgm::io
