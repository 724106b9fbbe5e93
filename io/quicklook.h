#pragma once

#include <string>

namespace hsgm::io {

/// How the values of a raster become a picture.
enum class QuicklookStyle {
    gray,      // stretched between two percentiles, nodata black
    hillshade, // 0 to 255 as they are
    disparity, // stretched on the colour map "turbo", nodata black
};

struct QuicklookOptions {
    QuicklookStyle style = QuicklookStyle::gray;
    /// Longest side of the picture; a smaller raster keeps its size.
    int max_side_px = 1024;
    /// The stretch of gray and disparity: these shares (in %) of the reduced picture's valid
    /// pixels lie below black or blue and white or red.
    double low_percentile = 2;
    double high_percentile = 98;

    /// Throws ConfigError naming the value and what is allowed.
    void validate() const;
};

/// Reduces the first band of a raster to a PNG by averaging its valid pixels. Throws
/// InputError for an unreadable raster and StorageError where the PNG cannot be written.
void write_quicklook_png(const std::string& raster_path, const std::string& png_path,
                         const QuicklookOptions& options = {});

} // namespace hsgm::io
