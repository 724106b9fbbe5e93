#pragma once

#include <string>
#include <vector>

namespace hsgm::io {

/// What a pixel of an overview is made of: the mean of the valid pixels that it covers, or, for
/// classes and codes, one of them.
enum class Overviews { mean, nearest };

/// Turns a finished GeoTIFF into a cloud-optimized one in place: statistics, overviews, blocks
/// of 512 x 512 in the order that readers over a network want. Keeps pixels, georeference,
/// nodata and metadata. `creation_options` are those of the raster: the ones that GDAL's COG
/// driver knows too (COMPRESS, LEVEL, PREDICTOR, BIGTIFF) are passed on. The file has its name
/// either as it was or when the new one is whole. Throws StorageError.
void make_cloud_optimized(const std::string& path,
                          const std::vector<std::string>& creation_options = {},
                          Overviews overviews = Overviews::mean);

} // namespace hsgm::io
