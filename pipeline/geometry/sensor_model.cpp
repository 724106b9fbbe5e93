#include "pipeline/geometry/sensor_model.h"

#include "pipeline/geometry/pointing.h"

namespace hsgm::geometry {

SensorModel SensorModel::corrected(const ImageCorrection& more) const
{
    return SensorModel(model_, joined(correction_, more));
}

SensorModel SensorModel::reduced(int factor) const
{
    // An affine function of the coarse point that does what that of the fine point does.
    ImageCorrection correction = correction_;
    const double middle = (factor - 1) / 2.0;
    correction.x_px += (correction.x_by_x + correction.x_by_y) * middle;
    correction.y_px += (correction.y_by_x + correction.y_by_y) * middle;
    correction.x_px /= factor;
    correction.y_px /= factor;
    if (const RpcModel* model = rpc()) {
        return SensorModel(geometry::reduced(*model, factor), correction);
    }
    return SensorModel(ortho()->reduced(factor), correction);
}

std::unique_ptr<GroundCamera> SensorModel::over(const MapProjection& map) const
{
    if (const RpcModel* model = rpc()) {
        return std::make_unique<RpcGroundCamera>(RpcCamera(*model, correction_), map);
    }
    return std::make_unique<OrthoGroundCamera>(*ortho(), correction_, map);
}

} // namespace hsgm::geometry
