#pragma once

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
/// height file, StorageError where the output cannot be written.
void write_hillshade(const std::string& height_path, const std::string& output_path,
                     const HillshadeOptions& options = {});

} // namespace hsgm::io
