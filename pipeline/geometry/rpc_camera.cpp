#include "pipeline/geometry/rpc_camera.h"

#include "pipeline/geometry/rpc_polynomial.h"

#include <cassert>
#include <cmath>
#include <limits>

namespace hsgm::geometry {

namespace {

constexpr int kMaxSteps = 40;
constexpr double kTolerancePx = 1e-6;

/// Longitudes of a scene across the date line come as 179.9 and as -180.1.
double unwrapped(double difference_deg)
{
    return difference_deg > 270    ? difference_deg - 360
           : difference_deg < -270 ? difference_deg + 360
                                   : difference_deg;
}

struct Normalised {
    double l = 0;
    double p = 0;
    double h = 0;
};

Normalised normalised(const RpcModel& m, double longitude_deg, double latitude_deg,
                      double height_m)
{
    return {unwrapped(longitude_deg - m.long_off_deg) / m.long_scale_deg,
            (latitude_deg - m.lat_off_deg) / m.lat_scale_deg,
            (height_m - m.height_off_m) / m.height_scale_m};
}

ImagePoint raw_projection(const RpcModel& m, const Normalised& n)
{
    const double samp = cubic(m.samp_num, n.l, n.p, n.h) / cubic(m.samp_den, n.l, n.p, n.h);
    const double line = cubic(m.line_num, n.l, n.p, n.h) / cubic(m.line_den, n.l, n.p, n.h);
    return {samp * m.samp_scale + m.samp_off, line * m.line_scale + m.line_off};
}

ImagePoint corrected(const ImageCorrection& c, ImagePoint raw)
{
    return {raw.x + (c.x_px + c.x_by_x * raw.x + c.x_by_y * raw.y),
            raw.y + (c.y_px + c.y_by_x * raw.x + c.y_by_y * raw.y)};
}

/// Derivatives of the sample and line by the normalised coordinates.
struct RawGradients {
    Gradient x;
    Gradient y;
};

Gradient scaled(Gradient g, double scale, double offset)
{
    return {g.value * scale + offset, g.by_l * scale, g.by_p * scale, g.by_h * scale};
}

RawGradients raw_gradients(const RpcModel& m, const Normalised& n)
{
    const Gradient samp = ratio(cubic_gradient(m.samp_num, n.l, n.p, n.h),
                                cubic_gradient(m.samp_den, n.l, n.p, n.h));
    const Gradient line = ratio(cubic_gradient(m.line_num, n.l, n.p, n.h),
                                cubic_gradient(m.line_den, n.l, n.p, n.h));
    return {scaled(samp, m.samp_scale, m.samp_off), scaled(line, m.line_scale, m.line_off)};
}

RawGradients gradients(const RpcModel& m, const ImageCorrection& c, const Normalised& n)
{
    const RawGradients raw = raw_gradients(m, n);
    const ImagePoint point = corrected(c, {raw.x.value, raw.y.value});
    const auto mix = [](double a, double x, double b, double y) { return a * x + b * y; };
    RawGradients result;
    result.x = {point.x, mix(1 + c.x_by_x, raw.x.by_l, c.x_by_y, raw.y.by_l),
                mix(1 + c.x_by_x, raw.x.by_p, c.x_by_y, raw.y.by_p),
                mix(1 + c.x_by_x, raw.x.by_h, c.x_by_y, raw.y.by_h)};
    result.y = {point.y, mix(c.y_by_x, raw.x.by_l, 1 + c.y_by_y, raw.y.by_l),
                mix(c.y_by_x, raw.x.by_p, 1 + c.y_by_y, raw.y.by_p),
                mix(c.y_by_x, raw.x.by_h, 1 + c.y_by_y, raw.y.by_h)};
    return result;
}

} // namespace

RpcModel crop(RpcModel model, ImagePoint first)
{
    model.samp_off -= first.x;
    model.line_off -= first.y;
    return model;
}

RpcModel reduced(RpcModel model, int factor)
{
    // The centre of the first coarse pixel lies between the centres of its pixels.
    const double middle = (factor - 1) / 2.0;
    model.samp_off = (model.samp_off - middle) / factor;
    model.line_off = (model.line_off - middle) / factor;
    model.samp_scale /= factor;
    model.line_scale /= factor;
    return model;
}

RpcCamera::RpcCamera(const RpcModel& model, const ImageCorrection& correction)
    : model_(model), correction_(correction)
{
}

ImagePoint RpcCamera::project(const GeodeticPoint& ground) const
{
    const Normalised n =
        normalised(model_, ground.longitude_deg, ground.latitude_deg, ground.height_m);
    return corrected(correction_, raw_projection(model_, n));
}

ImagePoint RpcCamera::project(const GeodeticPoint& ground, ImageJacobian& jacobian) const
{
    const Normalised n =
        normalised(model_, ground.longitude_deg, ground.latitude_deg, ground.height_m);
    const RawGradients g = gradients(model_, correction_, n);
    jacobian = {g.x.by_l / model_.long_scale_deg, g.x.by_p / model_.lat_scale_deg,
                g.x.by_h / model_.height_scale_m, g.y.by_l / model_.long_scale_deg,
                g.y.by_p / model_.lat_scale_deg,  g.y.by_h / model_.height_scale_m};
    return {g.x.value, g.y.value};
}

void RpcCamera::project(std::span<const double> longitude_deg,
                        std::span<const double> latitude_deg, std::span<const double> height_m,
                        std::span<double> x, std::span<double> y) const
{
    assert(latitude_deg.size() == longitude_deg.size() && x.size() == longitude_deg.size());
    assert(height_m.size() == longitude_deg.size() && y.size() == longitude_deg.size());
    // Copies on the stack, so that the compiler sees that writing x and y changes no
    // coefficient, and does several points at once.
    const RpcModel model = model_;
    const ImageCorrection correction = correction_;
    const std::size_t count = longitude_deg.size();
    for (std::size_t i = 0; i < count; ++i) {
        const ImagePoint point = corrected(
            correction, raw_projection(model, normalised(model, longitude_deg[i],
                                                         latitude_deg[i], height_m[i])));
        x[i] = point.x;
        y[i] = point.y;
    }
}

std::optional<GeodeticPoint> RpcCamera::locate(ImagePoint image, double height_m) const
{
    Normalised n = normalised(model_, model_.long_off_deg, model_.lat_off_deg, height_m);
    for (int step = 0; step < kMaxSteps; ++step) {
        const RawGradients g = gradients(model_, correction_, n);
        const double dx = image.x - g.x.value;
        const double dy = image.y - g.y.value;
        if (std::abs(dx) < kTolerancePx && std::abs(dy) < kTolerancePx) {
            double longitude_deg = model_.long_off_deg + n.l * model_.long_scale_deg;
            longitude_deg += longitude_deg > 180 ? -360 : longitude_deg < -180 ? 360 : 0;
            return GeodeticPoint{longitude_deg, model_.lat_off_deg + n.p * model_.lat_scale_deg,
                                 height_m};
        }
        const double determinant = g.x.by_l * g.y.by_p - g.x.by_p * g.y.by_l;
        n.l += (dx * g.y.by_p - dy * g.x.by_p) / determinant;
        n.p += (dy * g.x.by_l - dx * g.y.by_l) / determinant;
        if (!std::isfinite(n.l) || !std::isfinite(n.p)) {
            break;
        }
    }
    return std::nullopt;
}

void RpcCamera::locate(std::span<const double> x, std::span<const double> y,
                       std::span<const double> height_m, std::span<double> longitude_deg,
                       std::span<double> latitude_deg) const
{
    assert(y.size() == x.size() && height_m.size() == x.size());
    assert(longitude_deg.size() == x.size() && latitude_deg.size() == x.size());
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < x.size(); ++i) {
        const auto ground = locate({x[i], y[i]}, height_m[i]);
        longitude_deg[i] = ground ? ground->longitude_deg : kNone;
        latitude_deg[i] = ground ? ground->latitude_deg : kNone;
    }
}

} // namespace hsgm::geometry
