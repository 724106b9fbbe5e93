#pragma once

// Private to this folder, like gdal_private.h.

#include "io/gdal_private.h"
#include "io/image_spec.h"
#include "tiling/rect.h"

#include <limits>
#include <string>
#include <vector>

namespace hsgm::io {

/// One stored band and the value in it that means "no value" (NaN: none).
struct Channel {
    GDALRasterBandH band = nullptr;
    double nodata = std::numeric_limits<double>::quiet_NaN();
};

/// The bands that make the grey image of a specification: one, or red, green and blue.
/// Throws InputError for a band that is not there or whose pixels we cannot hold.
std::vector<Channel> choose_channels(GDALDatasetH dataset, const ImageSpec& spec);

/// The bands of the same file whose zeros mark pixels without a value: masks and alpha.
std::vector<GDALRasterBandH>
find_masks(GDALDatasetH dataset, const std::vector<Channel>& channels, const ImageSpec& spec);

/// OpenCV's weights of red, green and blue, in integers: the same bits on every machine.
double luminance(double red, double green, double blue);

tiling::Size size_of(GDALDatasetH dataset);

/// For messages: "3 rows x 4 columns", "rows 0-2, columns 0-3".
std::string to_text(tiling::Size size);
std::string to_text(const tiling::Rect& window);

} // namespace hsgm::io
