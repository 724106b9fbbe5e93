#pragma once

#include "io/pixel_type.h"

#include <cpl_string.h>

#include <string>
#include <vector>

namespace hsgm::io {

/// The creation options of a GeoTIFF: our defaults, changed and extended by the user's
/// `KEY=VALUE` entries. Throws ConfigError, naming `path`, for what GDAL would refuse or
/// ignore. (Private to this folder, like gdal_private.h.)
CPLStringList geotiff_options(const std::string& path, PixelType type,
                              const std::vector<std::string>& overrides);

} // namespace hsgm::io
