#pragma once

#include "io/pending_file.h"
#include "io/pixel_type.h"
#include "tiling/rect.h"

namespace hsgm::io {

/// Opens a GeoTIFF that was just closed and checks that size and type are as meant, that
/// every block lies inside the file (unless `may_omit`), and that the first and the last one
/// decode. GDAL 3.6 closes without an answer, so a full disk may show only here. Throws
/// StorageError.
void check_stored_blocks(const PendingFile& file, tiling::Size size, PixelType type,
                         bool may_omit);

} // namespace hsgm::io
