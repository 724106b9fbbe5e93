#pragma once

#include "pipeline/geometry/map_projection.h"
#include "pipeline/geometry/points.h"
#include "pipeline/geometry/rpc_camera.h"

#include <optional>

namespace hsgm::geometry {

/// An image and where it shows places of a map in metres with heights above the ellipsoid:
/// what the epipolar frame and triangulation ask of any sensor.
class GroundCamera {
public:
    virtual ~GroundCamera() = default;
    /// Where the image shows a place; not finite where it cannot.
    virtual ImagePoint project(const MapPoint& place) const = 0;
    /// The place of a given height that the image shows at `image`, if there is one.
    virtual std::optional<MapPoint> locate(ImagePoint image, double height_m) const = 0;
};

/// A camera with a rational polynomial model. Not to be shared between threads, because PROJ
/// is not.
class RpcGroundCamera final : public GroundCamera {
public:
    /// `map` is in metres and keeps heights above the ellipsoid.
    RpcGroundCamera(const RpcCamera& camera, const MapProjection& map)
        : camera_(camera), map_(map.copy())
    {
    }
    const RpcCamera& rpc() const { return camera_; }
    ImagePoint project(const MapPoint& place) const override
    {
        return camera_.project(map_.inverse(place));
    }
    std::optional<MapPoint> locate(ImagePoint image, double height_m) const override
    {
        const auto ground = camera_.locate(image, height_m);
        return ground ? std::optional(map_.forward(*ground)) : std::nullopt;
    }

private:
    RpcCamera camera_;
    MapProjection map_;
};

} // namespace hsgm::geometry
