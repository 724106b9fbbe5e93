#pragma once

// Private to this folder, like gdal_private.h.

#include "io/image_spec.h"
#include "io/vector_file_private.h"
#include "tiling/image.h"
#include "tiling/rect.h"

#include <string>
#include <vector>

namespace hsgm::io {

/// Polygons in which an image has no value: clouds, say. In pixels of the image (x to the
/// right, y down, 0 at the corner of the first one) where their file has no reference system;
/// else brought there by the image's map, or by its RPC at the model's middle height.
class VectorMask {
public:
    /// Of the file `spec.mask`, for the image `image`. Throws InputError where it cannot be
    /// read or brought into the image.
    VectorMask(const ImageSpec& spec, GDALDatasetH image);

    /// 0 where the centre of a pixel of the window lies in a polygon, else 1.
    void read(const tiling::Rect& window, tiling::ImageView<double> mask) const;
    /// The files that it comes from.
    const std::vector<std::string>& files() const { return files_; }

private:
    std::string path_;
    std::vector<Geometry> polygons_;
    std::vector<std::string> files_;
};

} // namespace hsgm::io
