#include "pipeline/geometry/rpc_fit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace hsgm::geometry {

namespace {

struct Scale {
    double offset = 0;
    double scale = 1;

    double operator()(double v) const { return (v - offset) / scale; }
};

// To -1..1 over the values.
template <typename Points, typename Get>
Scale scale_of(const Points& points, Get get)
{
    double low = get(points[0]);
    double high = low;
    for (const auto& point : points) {
        low = std::min(low, get(point));
        high = std::max(high, get(point));
    }
    return {(low + high) / 2, high > low ? (high - low) / 2 : 1};
}

// In the order of RPC00B, as rpc_polynomial.h has it.
Eigen::Matrix<double, 1, 20> terms(double l, double p, double h)
{
    Eigen::Matrix<double, 1, 20> t;
    t << 1, l, p, h, l * p, l * h, p * h, l * l, p * p, h * h, p * l * h, l * l * l, l * p * p,
        l * h * h, l * l * p, p * p * p, p * h * h, l * l * h, p * p * h, h * h * h;
    return t;
}

} // namespace

RpcModel fit_rpc(std::span<const GeodeticPoint> ground, std::span<const ImagePoint> image)
{
    constexpr std::size_t kLeastPoints = 64;
    if (ground.size() != image.size() || ground.size() < kLeastPoints) {
        throw std::invalid_argument("a model needs 64 pairs of points or more");
    }
    const Scale l = scale_of(ground, [](const GeodeticPoint& g) { return g.longitude_deg; });
    const Scale p = scale_of(ground, [](const GeodeticPoint& g) { return g.latitude_deg; });
    const Scale h = scale_of(ground, [](const GeodeticPoint& g) { return g.height_m; });
    const Scale x = scale_of(image, [](const ImagePoint& i) { return i.x; });
    const Scale y = scale_of(image, [](const ImagePoint& i) { return i.y; });
    const auto count = static_cast<Eigen::Index>(ground.size());
    Eigen::MatrixXd design(count, 20);
    Eigen::MatrixXd wanted(count, 2);
    for (std::size_t i = 0; i < ground.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        design.row(row) =
            terms(l(ground[i].longitude_deg), p(ground[i].latitude_deg), h(ground[i].height_m));
        wanted(row, 0) = x(image[i].x);
        wanted(row, 1) = y(image[i].y);
    }
    const Eigen::MatrixXd found = design.colPivHouseholderQr().solve(wanted);
    RpcModel model;
    std::tie(model.long_off_deg, model.long_scale_deg) = std::pair(l.offset, l.scale);
    std::tie(model.lat_off_deg, model.lat_scale_deg) = std::pair(p.offset, p.scale);
    std::tie(model.height_off_m, model.height_scale_m) = std::pair(h.offset, h.scale);
    std::tie(model.samp_off, model.samp_scale) = std::pair(x.offset, x.scale);
    std::tie(model.line_off, model.line_scale) = std::pair(y.offset, y.scale);
    for (std::size_t i = 0; i < 20; ++i) {
        model.samp_num[i] = found(static_cast<Eigen::Index>(i), 0);
        model.line_num[i] = found(static_cast<Eigen::Index>(i), 1);
    }
    model.samp_den[0] = 1;
    model.line_den[0] = 1;
    return model;
}

} // namespace hsgm::geometry
