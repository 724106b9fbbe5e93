#pragma once

#include "pipeline/geometry/points.h"

#include <array>
#include <optional>
#include <span>

namespace hsgm::geometry {

/// A rational polynomial model of an image (RPC00B: NIMA, The Compendium of Controlled
/// Extensions for NITF, STDI-0002, section 8.2.4). Lines and samples are pixels counted from
/// 0 at the centre of the first pixel; scales may be negative (an image turned by 180
/// degrees), but not 0.
struct RpcModel {
    double line_off = 0;
    double samp_off = 0;
    double lat_off_deg = 0;
    double long_off_deg = 0;
    double height_off_m = 0;
    double line_scale = 1;
    double samp_scale = 1;
    double lat_scale_deg = 1;
    double long_scale_deg = 1;
    double height_scale_m = 1;
    std::array<double, 20> line_num{};
    std::array<double, 20> line_den{};
    std::array<double, 20> samp_num{};
    std::array<double, 20> samp_den{};

    bool operator==(const RpcModel&) const = default;
};

/// The model of a part of an image whose first pixel is pixel `first` of the whole.
RpcModel crop(RpcModel model, ImagePoint first);

/// The model of an image whose pixels are the means of `factor` x `factor` pixels.
RpcModel reduced(RpcModel model, int factor);

/// What is added to the image points of a model to mend its pointing: an affine function of
/// the point itself, in pixels. All zero: nothing.
struct ImageCorrection {
    double x_px = 0;
    double x_by_x = 0;
    double x_by_y = 0;
    double y_px = 0;
    double y_by_x = 0;
    double y_by_y = 0;

    bool operator==(const ImageCorrection&) const = default;
};

/// A camera behind a rational polynomial model. Immutable, so threads may share one.
class RpcCamera {
public:
    explicit RpcCamera(const RpcModel& model, const ImageCorrection& correction = {});

    const RpcModel& model() const { return model_; }
    const ImageCorrection& correction() const { return correction_; }

    /// Where the image shows a ground point; also outside the model's range, where it means
    /// less and less. Not finite where a denominator vanishes.
    ImagePoint project(const GeodeticPoint& ground) const;
    /// The same with the derivatives by longitude, latitude (px/degree) and height (px/m).
    ImagePoint project(const GeodeticPoint& ground, ImageJacobian& jacobian) const;
    /// Many points at once; all spans have one length.
    void project(std::span<const double> longitude_deg, std::span<const double> latitude_deg,
                 std::span<const double> height_m, std::span<double> x,
                 std::span<double> y) const;

    /// The ground point of a given height that the image shows at `image`, by Newton's method
    /// to 1e-6 px. Nothing where it does not converge: the point is far outside the model.
    std::optional<GeodeticPoint> locate(ImagePoint image, double height_m) const;
    /// Many points at once; NaN where there is none. All spans have one length.
    void locate(std::span<const double> x, std::span<const double> y,
                std::span<const double> height_m, std::span<double> longitude_deg,
                std::span<double> latitude_deg) const;

private:
    RpcModel model_;
    ImageCorrection correction_;
};

} // namespace hsgm::geometry
