#pragma once

// Private to this folder, like gdal_private.h.

#include "io/gdal_private.h"

#include <ogr_api.h>

#include <memory>
#include <string>
#include <vector>

namespace hsgm::io {

struct GeometryDestroyer {
    void operator()(OGRGeometryH geometry) const { OGR_G_DestroyGeometry(geometry); }
};
using Geometry = std::unique_ptr<void, GeometryDestroyer>;

/// Throws InputError with GDAL's own message.
Dataset open_vector(const std::string& path);

/// Whether GDAL knows the file as polygons rather than pixels.
bool is_vector(const std::string& path);

/// The polygons of the first layer that has any, without curves and heights; none where there
/// is none.
std::vector<Geometry> polygons_of(GDALDatasetH dataset);

/// WKT of what their coordinates are in; empty: the file does not say.
std::string crs_of_polygons(GDALDatasetH dataset);

} // namespace hsgm::io
