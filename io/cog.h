#pragma once

#include <string>
#include <vector>

namespace hsgm::io {

/// Turns a finished GeoTIFF into a cloud-optimized one in place: statistics, overviews (means
/// of valid pixels), blocks of 512 x 512 in the order that readers over a network want. Keeps
/// pixels, georeference, nodata and metadata. `creation_options` are those of the raster: the
/// ones that GDAL's COG driver knows too (COMPRESS, LEVEL, PREDICTOR, BIGTIFF) are passed on.
/// The file has its name either as it was or when the new one is whole. Throws StorageError.
void make_cloud_optimized(const std::string& path,
                          const std::vector<std::string>& creation_options = {});

} // namespace hsgm::io
