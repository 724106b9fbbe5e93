#pragma once

#include "pipeline/geometry/ground_camera.h"
#include "pipeline/geometry/map_grid.h"
#include "pipeline/geometry/rpc_camera.h"
#include "tiling/rect.h"

#include <optional>
#include <string>

namespace hsgm::geometry {

/// An orthoimage and how it was taken. What stands above (or lies below) the surface that the
/// image was made on appears beside its place: at place X', of surface height r, the image
/// shows the point of height h whose place is
///
///     X = X' + b (h - r)         b: metres that its ray moves to the side per metre up
///
/// Frames and rays are made with the *levelled* image: the same image as if it had been made on
/// the plane at `level_m`, so that the relief of its surface is out of the way and everything
/// is smooth. Pixel X' of the orthoimage is pixel X' + b (level_m - r(X')) of the levelled one;
/// ReliefWarp goes back. Pixels of the levelled image count from `margin_px` outside the
/// orthoimage's first, because the relief may move them there.
struct OrthoModel {
    tiling::Size size; ///< of the orthoimage
    MapGrid grid;
    std::string crs;      ///< its horizontal reference system, as MapProjection reads it
    double level_m = 0;   ///< of the plane that it was made on, or about that of its surface
    double margin_px = 0; ///< 0 for images made on a plane
    double slope_x = 0;   ///< b in units of the image's map per metre; unless there is `rpc`
    double slope_y = 0;
    std::optional<RpcModel> rpc; ///< of the raw image: gives b at every place

    tiling::Size levelled_size() const;
    /// The model of an image whose pixels are the means of `factor` x `factor` pixels.
    OrthoModel reduced(int factor) const;

    bool operator==(const OrthoModel&) const = default;
};

/// How a ray moves on an image's map per metre up, from how the image was taken, at the middle
/// of the image: `azimuth_deg` of the satellite as seen from the ground, clockwise from north,
/// `incidence_deg` from the zenith to it.
ImagePoint slope_of_view(const MapGrid& grid, tiling::Size size, const MapProjection& map,
                         double azimuth_deg, double incidence_deg);

/// The same from metres to the east and north per metre up: of the grid for maps in metres, of
/// the true directions for maps in degrees.
ImagePoint slope_of_vector(const MapGrid& grid, tiling::Size size, const MapProjection& map,
                           double east, double north);

/// The levelled image as a camera over a map in metres. Not to be shared between threads.
class OrthoGroundCamera final : public GroundCamera {
public:
    OrthoGroundCamera(const OrthoModel& model, const ImageCorrection& correction,
                      const MapProjection& map);
    ImagePoint project(const MapPoint& place) const override;
    std::optional<MapPoint> locate(ImagePoint image, double height_m) const override;

private:
    OrthoModel model_;
    ImageCorrection correction_;
    MapProjection map_;
    MapProjection image_map_;
    std::optional<RpcCamera> rays_;
};

} // namespace hsgm::geometry
