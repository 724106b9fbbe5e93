#include "pipeline/geometry/ortho_model.h"

#include <cmath>
#include <numbers>

namespace hsgm::geometry {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// WGS84's half axis, and square of its eccentricity.
constexpr double kHalfAxisM = 6378137;
constexpr double kEccentricity2 = 6.69437999014e-3;

MapPoint middle_of(const MapGrid& grid, tiling::Size size)
{
    return grid.place_of({(size.cols - 1) / 2.0, (size.rows - 1) / 2.0});
}

/// How far a place moves on a map for so many metres to the true east and north.
ImagePoint moved_on_map(const MapProjection& map, const MapPoint& place, double east_m,
                        double north_m)
{
    const GeodeticPoint here = map.inverse(place);
    const double sine = std::sin(here.latitude_deg * kDegree);
    const double w2 = 1 - kEccentricity2 * sine * sine;
    const double east_radius =
        kHalfAxisM / std::sqrt(w2) * std::cos(here.latitude_deg * kDegree);
    const double north_radius = kHalfAxisM * (1 - kEccentricity2) / (w2 * std::sqrt(w2));
    const MapPoint there =
        map.forward({here.longitude_deg + east_m / east_radius / kDegree,
                     here.latitude_deg + north_m / north_radius / kDegree, here.height_m});
    return {there.x - place.x, there.y - place.y};
}

} // namespace

tiling::Size OrthoModel::levelled_size() const
{
    const auto grown = [&](int px) { return static_cast<int>(std::ceil(px + 2 * margin_px)); };
    return {grown(size.rows), grown(size.cols)};
}

OrthoModel OrthoModel::reduced(int factor) const
{
    OrthoModel model = *this;
    model.size = {tiling::ceil_div(size.rows, factor), tiling::ceil_div(size.cols, factor)};
    model.grid = grid.reduced(factor);
    model.margin_px = margin_px / factor;
    return model;
}

ImagePoint slope_of_view(const MapGrid& grid, tiling::Size size, const MapProjection& map,
                         double azimuth_deg, double incidence_deg)
{
    const double aside = std::tan(incidence_deg * kDegree);
    return moved_on_map(map, middle_of(grid, size), aside * std::sin(azimuth_deg * kDegree),
                        aside * std::cos(azimuth_deg * kDegree));
}

ImagePoint slope_of_vector(const MapGrid& grid, tiling::Size size, const MapProjection& map,
                           double east, double north)
{
    return map.in_metres() ? ImagePoint{east, north}
                           : moved_on_map(map, middle_of(grid, size), east, north);
}

OrthoGroundCamera::OrthoGroundCamera(const OrthoModel& model, const ImageCorrection& correction,
                                     const MapProjection& map)
    : model_(model), correction_(correction), map_(map.copy()),
      image_map_(MapProjection::from_text(model.crs))
{
    if (model_.rpc) {
        rays_.emplace(*model_.rpc);
    }
}

ImagePoint OrthoGroundCamera::project(const MapPoint& place) const
{
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const GeodeticPoint ground = map_.inverse(place);
    MapPoint on_plane;
    if (rays_) {
        const auto met = rays_->locate(rays_->project(ground), model_.level_m);
        if (!met) {
            return {kNone, kNone};
        }
        on_plane = image_map_.forward(*met);
    } else {
        on_plane = image_map_.forward(ground);
        on_plane.x += model_.slope_x * (model_.level_m - place.height_m);
        on_plane.y += model_.slope_y * (model_.level_m - place.height_m);
    }
    ImagePoint pixel = model_.grid.pixel_of(on_plane.x, on_plane.y);
    pixel.x += model_.margin_px;
    pixel.y += model_.margin_px;
    const ImageCorrection& c = correction_;
    return {pixel.x + c.x_px + c.x_by_x * pixel.x + c.x_by_y * pixel.y,
            pixel.y + c.y_px + c.y_by_x * pixel.x + c.y_by_y * pixel.y};
}

std::optional<MapPoint> OrthoGroundCamera::locate(ImagePoint image, double height_m) const
{
    const ImageCorrection& c = correction_;
    const double x = image.x - c.x_px;
    const double y = image.y - c.y_px;
    const double determinant = (1 + c.x_by_x) * (1 + c.y_by_y) - c.x_by_y * c.y_by_x;
    const ImagePoint pixel{(x * (1 + c.y_by_y) - y * c.x_by_y) / determinant,
                           (y * (1 + c.x_by_x) - x * c.y_by_x) / determinant};
    MapPoint place =
        model_.grid.place_of({pixel.x - model_.margin_px, pixel.y - model_.margin_px});
    if (!rays_) {
        place.x -= model_.slope_x * (model_.level_m - height_m);
        place.y -= model_.slope_y * (model_.level_m - height_m);
        place.height_m = height_m;
        place = map_.forward(image_map_.inverse(place));
    } else {
        place.height_m = model_.level_m;
        const auto ground = rays_->locate(rays_->project(image_map_.inverse(place)), height_m);
        if (!ground) {
            return std::nullopt;
        }
        place = map_.forward(*ground);
    }
    return std::isfinite(place.x) && std::isfinite(place.y) ? std::optional(place)
                                                            : std::nullopt;
}

} // namespace hsgm::geometry
