#pragma once

#include "pipeline/geometry/ground_camera.h"
#include "pipeline/geometry/ortho_model.h"
#include "pipeline/geometry/rpc_camera.h"

#include <memory>
#include <variant>

namespace hsgm::geometry {

/// How an image of a pair was taken, whatever its kind, with what mends its pointing. Its
/// pixels are those of the raw image, or of the levelled orthoimage. Immutable.
class SensorModel {
public:
    using Kind = std::variant<RpcModel, OrthoModel>;

    explicit SensorModel(Kind model, const ImageCorrection& correction = {})
        : model_(std::move(model)), correction_(correction)
    {
    }

    const Kind& model() const { return model_; }
    const RpcModel* rpc() const { return std::get_if<RpcModel>(&model_); }
    const OrthoModel* ortho() const { return std::get_if<OrthoModel>(&model_); }
    const ImageCorrection& correction() const { return correction_; }

    /// With more added to its correction.
    SensorModel corrected(const ImageCorrection& more) const;
    /// Of an image whose pixels are the means of `factor` x `factor` pixels.
    SensorModel reduced(int factor) const;
    /// Seen from a map in metres with heights above the ellipsoid. For one thread.
    std::unique_ptr<GroundCamera> over(const MapProjection& map) const;

private:
    Kind model_;
    ImageCorrection correction_;
};

} // namespace hsgm::geometry
