#pragma once

#include "io/raster_source.h"

#include <array>
#include <map>
#include <optional>
#include <string>

namespace hsgm::io {

/// A rational polynomial model as some file stores it, in the order of terms of RPC00B and
/// with offsets that count **pixel centres from 0**: line 0, sample 0 is the centre of the
/// first pixel. Latitude and longitude in degrees on WGS84, heights in metres above its
/// ellipsoid, lines and samples in pixels.
struct RpcMetadata {
    double line_off = 0;
    double samp_off = 0;
    double lat_off = 0;
    double long_off = 0;
    double height_off = 0;
    double line_scale = 1;
    double samp_scale = 1;
    double lat_scale = 1;
    double long_scale = 1;
    double height_scale = 1;
    std::array<double, 20> line_num{};
    std::array<double, 20> line_den{};
    std::array<double, 20> samp_num{};
    std::array<double, 20> samp_den{};
    /// The model is that of a whole scene, of which an image may be a part: an image without a
    /// map, whose geotransform says where in the scene it lies (.geom files of OTB).
    bool of_whole_scene = false;
    std::string origin; ///< for people: "left.tif" or "left.geom"

    bool operator==(const RpcMetadata&) const = default;
};

/// The model that GDAL finds for an image: in the TIFF's own tag, in an .RPB or _RPC.TXT file
/// beside it, in a DIMAP product. Nothing where there is none. Throws InputError for one that
/// is incomplete.
std::optional<RpcMetadata> stored_rpc(const RasterSource& image);

/// The values of a model by the keys of GDAL's RPC domain, each number with as many digits as
/// bring it back: what `RasterOptions::rpc` takes.
std::map<std::string, std::string> rpc_items(const RpcMetadata& rpc);

/// The model of a file given by name: _RPC.TXT ("LINE_OFF: 12"), .geom of OSSIM or OTB,
/// .RPB ("lineOffset = 12;") or DIMAP's RPC_*.XML, told apart by what they hold; or another
/// image (.tif, .jp2, .ntf, .vrt), whose model GDAL finds. The terms of
/// an RPC00A model are put into the order of RPC00B; DIMAP's count from 1 becomes one from 0.
/// Throws InputError for a file that is missing, unreadable, or lacks a value.
RpcMetadata read_rpc_file(const std::string& path);

/// At which pixel of its scene an image begins, sample and line: the corner of its first pixel
/// is that of a pixel of the scene, and so is its centre. (0, 0) for a model that is the
/// image's own, and for an image without a geotransform or on a map. Throws InputError where
/// the geotransform has other steps than one pixel.
std::array<double, 2> first_pixel_in_scene(const RpcMetadata& rpc, const GeoReference& geo,
                                           const std::string& image);

/// The .geom file beside an image, of which GDAL knows nothing: "a.geom" of "a.tif"; empty
/// where there is none.
std::string geom_beside(const std::string& image);

} // namespace hsgm::io
