#pragma once

#include "io/geo_reference.h"
#include "io/image_spec.h"
#include "io/pixel_type.h"
#include "tiling/image.h"
#include "tiling/rect.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace hsgm::io {

/// One grey image inside a raster file, read window by window. Holds one GDAL handle: move it
/// to another thread if you like, but open one source per thread to read side by side.
class RasterSource {
public:
    /// Opens the file and, where the specification names one, its mask. Throws InputError for
    /// a file that is missing, no raster, of a complex or unknown pixel type, without the
    /// band asked for, or with a mask of another size.
    explicit RasterSource(ImageSpec spec);
    ~RasterSource();
    RasterSource(RasterSource&&) noexcept;
    RasterSource& operator=(RasterSource&&) noexcept;

    tiling::Size size() const;
    /// Of the band as stored; a luminance has the type of its three bands.
    PixelType pixel_type() const;
    /// How many bands the file has.
    int bands() const;
    GeoReference geo_reference() const;
    /// The pieces in which the file stores its pixels; windows aligned to it read fastest.
    tiling::Size block_size() const;
    const std::string& path() const;
    /// For people: "left.tif, band 1" or "left.tif, luminance of bands 1-3".
    std::string description() const;
    /// GDAL's metadata of one domain, as stored: "" is the general one, "RPC" holds rational
    /// polynomials. Empty where there is none.
    std::map<std::string, std::string> metadata(const std::string& domain) const;

    /// The files that its pixels come from, as GDAL knows them: the image, a mask, what stands
    /// beside it (headers, overviews, metadata).
    std::vector<std::string> files() const;

    /// Reads `window` (inside the image) into `values`, a view of the window's size. Numbers
    /// are as stored: no scale or offset is applied. A pixel without a value becomes NaN; that
    /// is one that
    ///   - equals the given or, failing that, the declared nodata value (a luminance: in all
    ///     three bands, because a saturated colour has zeros too),
    ///   - is zero in the file's own mask or alpha band, or in the mask file,
    ///   - is stored as NaN or infinity.
    /// Throws InputError with path, window and GDAL's message where the file cannot be read;
    /// the next read opens the file afresh, so trying again is safe.
    void read(const tiling::Rect& window, tiling::ImageView<double> values);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace hsgm::io
