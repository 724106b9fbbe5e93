#pragma once

#include "io/raster_source.h"
#include "io/rpc_metadata.h"
#include "pipeline/geometry/rpc_camera.h"

#include <string>

namespace hsgm::pipeline {

/// A stored model as the camera wants it.
geometry::RpcModel to_model(const io::RpcMetadata& stored);

/// The camera of an image: from the file given, or else from what the image carries. A model
/// of a whole scene is moved to the part that the image's geotransform says it is. Throws
/// InputError where there is no model, and how to give one.
geometry::RpcCamera open_camera(const io::RasterSource& image,
                                const std::string& rpc_file = "");

} // namespace hsgm::pipeline
