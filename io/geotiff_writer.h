#pragma once

#include "io/geo_reference.h"
#include "io/pixel_type.h"
#include "tiling/image.h"
#include "tiling/rect.h"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hsgm::io {

/// What a raster says about itself, and how it is stored.
struct RasterOptions {
    std::optional<double> nodata;
    GeoReference geo;
    /// Key and value, into the file's general metadata.
    std::map<std::string, std::string> metadata;
    /// A camera model, as `rpc_items` gives it; empty: none.
    std::map<std::string, std::string> rpc;
    /// The first one describes the writer's only band.
    std::vector<std::string> band_descriptions;
    /// Of the values, for example "metre".
    std::string unit;
    /// `KEY=VALUE` as in `gdalinfo --format GTiff`; each replaces or joins the defaults:
    /// tiles of 256 x 256, ZSTD of level 3 (DEFLATE where GDAL lacks it), predictor,
    /// BIGTIFF=IF_SAFER.
    std::vector<std::string> creation_options;
};

/// Throws ConfigError for creation options that GDAL refuses; touches no disk.
void check_creation_options(const std::string& path, PixelType type,
                            const std::vector<std::string>& creation_options);

/// Writes a GeoTIFF of one band, in pieces of any shape and order, each pixel once. Works on
/// a hidden temporary file; the output has its name only after `finish()`.
///
/// A block is compressed and written the moment its last pixel arrives, straight to the file
/// and never through GDAL's shared cache, so the same sequence of writes gives the same bytes
/// whatever else the program does. Blocks that are begun but not complete wait in memory
/// (`pending_bytes`): none where the pieces are aligned to `block_size`.
///
/// Not thread-safe; one writer is one thread's affair at a time.
class GeoTiffWriter {
public:
    /// Throws ConfigError for creation options that GDAL refuses, and StorageError where the
    /// folder is missing, not writable or full.
    GeoTiffWriter(std::string path, tiling::Size size, PixelType type,
                  RasterOptions options = {});
    /// Abandons what `finish` has not made final.
    ~GeoTiffWriter();
    GeoTiffWriter(GeoTiffWriter&&) noexcept;
    GeoTiffWriter& operator=(GeoTiffWriter&&) noexcept;

    tiling::Size size() const;
    tiling::Size block_size() const;
    /// Memory held by blocks that are not complete yet.
    std::size_t pending_bytes() const;

    /// Stores `pixels` at `rect` (inside the raster, of the view's size, overlapping no
    /// earlier piece). T must be the raster's pixel type. Throws StorageError where the disk
    /// is full or fails, and std::logic_error where a pixel comes twice.
    template <typename T>
    void write(const tiling::Rect& rect, tiling::ImageView<T> pixels)
    {
        write_bytes(rect, reinterpret_cast<const std::byte*>(pixels.data()), pixels.size(),
                    pixels.stride() * static_cast<std::ptrdiff_t>(sizeof(T)),
                    pixel_type_of<std::remove_const_t<T>>());
    }
    template <typename T>
    void write(const tiling::Rect& rect, const tiling::Image<T>& pixels)
    {
        write(rect, pixels.view());
    }

    /// Fills pixels that nobody wrote with the nodata value (else 0), closes the file and
    /// opens it again to see that every block is there. Throws StorageError; an earlier
    /// output of that name is untouched.
    void complete();
    /// Waits for the disk and gives a complete file its name. Throws StorageError; an earlier
    /// output of that name is then untouched.
    void publish();
    /// Both, for an output that stands alone. Of several, publish none before all are
    /// complete.
    void finish();

private:
    struct State;
    void write_bytes(const tiling::Rect& rect, const std::byte* pixels, tiling::Size size,
                     std::ptrdiff_t row_bytes, PixelType type);

    std::unique_ptr<State> state_;
};

} // namespace hsgm::io
